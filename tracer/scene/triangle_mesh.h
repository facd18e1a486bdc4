// A triangle mesh as its file has it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace raywalk {

struct TriangleMesh {
    std::vector<glm::vec3> positions;                       // as in the file, less `origin`; each named by a face
    std::vector<std::array<std::uint32_t, 3>> faces;        // indices into positions
    std::vector<glm::vec3> normals;                         // as in the file (unit length not promised); may be empty
    std::vector<std::array<std::int32_t, 3>> normal_faces;  // indices into normals or -1; empty, or one per face
    glm::dvec3 origin = glm::dvec3(0);                      // not 0 only where the file's mesh is far from it
};

// Why the mesh cannot be placed ("it has no faces"), or nothing.
std::string placement_problem(const TriangleMesh& mesh);

}  // namespace raywalk
