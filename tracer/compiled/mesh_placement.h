// From a mesh as its file has it to triangles where the scene wants them (spec 3, Mesh).
#pragma once

#include <span>
#include <vector>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// Loops of fewer turns than this run on one thread: waking the others takes longer.
inline constexpr std::size_t worth_threads = 4096;

// Brought to at most `largest_length` in magnitude: what is farther away could not be seen anyway.
float limited(double x);
glm::vec3 limited(const glm::dvec3& point);

// The mesh's vertices, their mean moved to `center`, the farthest scaled to `radius` from it. Computed in double.
// placement_problem() must be empty.
std::vector<glm::vec3> placed_positions(const TriangleMesh& mesh, const glm::dvec3& center, double radius);

// Unit normals of each face's three corners: the file's own where it has them, else the unweighted mean of the unit
// normals of the faces around the vertex, neighbours agreeing on their sides (winding.h), else (a mean of zero) the
// face's own.
std::vector<VertexNormals> corner_normals(const TriangleMesh& mesh);
void corner_normals(const TriangleMesh& mesh, std::span<VertexNormals> normals);  // one per face

// Unit normal by the order a, b, c; some unit vector for a triangle without area, which no ray hits.
glm::vec3 geometric_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace raywalk
