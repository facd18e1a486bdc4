// Meshes far from the origin, in coordinates of a map, say: single precision would round their vertices to steps that
// show. They are moved before they are rounded.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>

namespace raywalk {

// Where a mesh of this box is to have its origin: the middle of the box where the box is so far from 0 that single
// precision lacks four bits or more of it, else 0.
glm::dvec3 origin_for(const glm::dvec3& lower, const glm::dvec3& upper);

// The origin that the vertices of an OBJ file are likely to need: a few of them are looked at.
glm::dvec3 likely_origin(std::string_view text);

}  // namespace raywalk
