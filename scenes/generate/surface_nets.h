// Implicit surface -> closed triangle mesh.
#pragma once

#include <functional>

#include "scenes/generate/mesh.h"

namespace generate {

// Negative inside; near the surface about the distance to it.
using Field = std::function<float(const glm::vec3&)>;

// Meshes { p : field(p) = 0 } within the box, which the surface must not leave, by surface nets (Gibson 1998; sheets
// of one cube apart as in Nielson 2004) on cubes of side `step`: a vertex per cube and sheet, a quad per edge crossed.
// Vertices are then relaxed along the surface and put onto it exactly; normals are the field's gradient.
Mesh surface_nets(const Field& field, const glm::vec3& lower, const glm::vec3& upper, float step);

}  // namespace generate
