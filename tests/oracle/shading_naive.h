// The shading of the specification once more, as plainly as it can be written: double precision, recursion, a loop over
// all shapes. Planes, spheres and faces; pure and grid textures.
#pragma once

#include <glm/vec3.hpp>

#include "tracer/scene/scene.h"

namespace raywalk {

// Radiance along a camera ray. `direction`: unit vector.
glm::dvec3 naive_radiance(const Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction);

}  // namespace raywalk
