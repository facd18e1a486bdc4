#include "tests/bench/geometry.h"

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "tracer/compiled/mesh_placement.h"

namespace raywalk::bench {

namespace {

// Distance of the surface from the centre in the direction of the unit vector `p`.
double bumpy_radius(const glm::dvec3& p) {
    return 1 + 0.12 * std::sin(5 * p.x + 1) * std::sin(6 * p.y) * std::sin(5 * p.z + 2) +
           0.03 * std::sin(23 * p.x) * std::sin(21 * p.y + 1) * std::sin(25 * p.z) +
           0.006 * std::sin(97 * p.x + 2) * std::sin(101 * p.y) * std::sin(89 * p.z);
}

}  // namespace

std::vector<TriangleCorners> Geometry::corners() const {
    std::vector<TriangleCorners> result(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) result[f].p[i] = positions[faces[f][i]];
    return result;
}

TriangleMesh bumpy_sphere(std::size_t triangles) {
    // 2 k rings x 4 k segments, two triangles a cell but one at the poles: 16 k^2 - 8 k.
    auto k = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 16));
    while (16ull * k * k - 8ull * k < triangles) ++k;
    const std::uint32_t rings = 2 * k, segments = 4 * k;
    TriangleMesh mesh;
    const auto add = [&](double polar, double turn) {
        const glm::dvec3 p(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
        mesh.positions.emplace_back(p * bumpy_radius(p));
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t segment = 0; segment < segments; ++segment)
            add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * segment / segments);
    add(std::numbers::pi, 0);

    const auto vertex = [&](std::uint32_t ring, std::uint32_t segment) {
        if (ring == 0) return 0u;
        if (ring == rings) return static_cast<std::uint32_t>(mesh.positions.size() - 1);
        return 1 + (ring - 1) * segments + segment % segments;
    };
    for (std::uint32_t ring = 0; ring < rings; ++ring) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            const std::uint32_t a = vertex(ring, s), b = vertex(ring, s + 1);
            const std::uint32_t c = vertex(ring + 1, s), d = vertex(ring + 1, s + 1);
            if (ring != 0) mesh.faces.push_back({a, b, d});
            if (ring + 1 != rings) mesh.faces.push_back({a, d, c});
        }
    }
    return mesh;
}

std::vector<SphereShape> ball_field() {
    std::vector<SphereShape> balls;
    const float radius = 0.42f;
    for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 100; ++column)
            balls.push_back(
                {{static_cast<float>(column) - 49.5f, floor_height + radius, 8.0f - static_cast<float>(row)}, radius});
    return balls;
}

Geometry placed(const TriangleMesh& mesh, std::string name) {
    if (const std::string problem = placement_problem(mesh); !problem.empty())
        throw std::runtime_error(name + ": " + problem);
    Geometry geometry{.name = std::move(name),
                      .positions = placed_positions(mesh, {0, mesh_height, 0}, mesh_radius),
                      .faces = mesh.faces,
                      .corner_normals = {},
                      .spheres = {}};
    for (const VertexNormals& normals : corner_normals(mesh)) {
        auto& corner = geometry.corner_normals.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) corner[i] = {normals.n[3 * i], normals.n[3 * i + 1], normals.n[3 * i + 2]};
    }
    return geometry;
}

Geometry read_mesh(const std::filesystem::path& file) {
    std::vector<Diagnostic> warnings;
    return placed(read_obj(file, Limits{}, warnings), file.stem().string());
}

void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "w"), std::fclose);
    if (!out) throw std::runtime_error("cannot write " + file.string());
    for (const glm::vec3& p : mesh.positions)
        std::fprintf(out.get(), "v %.7g %.7g %.7g\n", double{p.x}, double{p.y}, double{p.z});
    for (const auto& face : mesh.faces) std::fprintf(out.get(), "f %u %u %u\n", face[0] + 1, face[1] + 1, face[2] + 1);
    if (std::ferror(out.get()) != 0) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace raywalk::bench
