// An indexed triangle mesh in the making, what is wrong with it, and its way into an OBJ file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

namespace generate {

// Faces run anticlockwise seen from outside. `normals`: one per position, or none.
struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<std::array<std::uint32_t, 3>> faces;
};

// Edges by the number of faces at them. A closed surface has neither open nor crowded (more than two, or two that run
// the same way) edges; boundary_loops counts the closed chains of open ones.
struct Edges {
    std::size_t open = 0, crowded = 0, boundary_loops = 0;
};
Edges count_edges(const Mesh& mesh);

// Vertices of the same place become one, faces that collapse go.
Mesh welded(const Mesh& mesh, float tolerance);

// The OBJ text, `about` as a comment on top.
std::string obj_text(const Mesh& mesh, std::string_view about);

}  // namespace generate
