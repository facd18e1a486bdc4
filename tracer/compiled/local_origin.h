// Where single precision counts from. Floats are fine near zero only, so a scene that lies far away from it, in a
// surveyor's coordinates for one, is moved to an origin of its own in double precision, before anything becomes a
// float.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "tracer/ground/error.h"
#include "tracer/scene/scene.h"

namespace raywalk {

// The middle of the eye and all shapes that end, in whole units, where it lies farther from zero than `far_away` times
// their extent; else zero, so that scenes near zero keep their bits. Planes end nowhere, and lights may be suns.
inline constexpr double far_away = 16;
glm::dvec3 local_origin(const Scene& scene);

// The scene with `origin` as its zero. The coordinates of images and grids on planes change: PlaneRecord::shift mends
// that.
Scene moved_to(const glm::dvec3& origin, Scene scene);

// A warning where single precision cannot hold some shapes: smaller than 2^-20 of their distance from the local origin.
std::vector<Diagnostic> small_shape_warnings(const Scene& scene);

}  // namespace raywalk
