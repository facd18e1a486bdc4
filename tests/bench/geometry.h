// What the benchmark traces: meshes read or made here, and a field of ten thousand spheres.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "tracer/compiled/hierarchy.h"
#include "tracer/files/mesh/obj_reader.h"

namespace raywalk::bench {

// Every mesh stands here, its farthest vertex `mesh_radius` from the centre; the floor and its spheres lie below.
inline constexpr double mesh_radius = 4;
inline constexpr double mesh_height = 3;  // of the centre, which lies on the y axis
inline constexpr float floor_height = -1;

struct Geometry {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::vector<std::array<glm::vec3, 3>> corner_normals;  // unit, one per face
    std::vector<SphereShape> spheres;

    [[nodiscard]] std::vector<TriangleCorners> corners() const;
};

// A sphere with bumps of several sizes, `triangles` of them or a few more.
TriangleMesh bumpy_sphere(std::size_t triangles);
// 100 x 100 balls on the floor.
std::vector<SphereShape> ball_field();

// The mesh put in its place, named `name`.
Geometry placed(const TriangleMesh& mesh, std::string name);
Geometry read_mesh(const std::filesystem::path& file);

void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file);

}  // namespace raywalk::bench
