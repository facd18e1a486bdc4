#include "tracer/compiled/mesh_placement.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tracer/compiled/winding.h"
#include "tracer/scene/limits.h"

namespace raywalk {

float limited(double x) { return static_cast<float>(std::clamp(x, -largest_length, largest_length)); }
glm::vec3 limited(const glm::dvec3& point) { return {limited(point.x), limited(point.y), limited(point.z)}; }

namespace {

// The unit vector along v, or zero where v has no direction.
glm::dvec3 direction_of(const glm::dvec3& v) {
    const double squared = glm::dot(v, v);
    if (squared > 1e-200 && squared < 1e200) return v / std::sqrt(squared);
    // Scaled first, so that the square of a tiny or huge component neither vanishes nor overflows.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0) || std::isinf(largest)) return glm::dvec3(0);
    return glm::normalize(v / largest);
}

glm::dvec3 face_direction(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return direction_of(glm::cross(b - a, c - a));
}

glm::dvec3 vertex_mean(const TriangleMesh& mesh) {
    glm::dvec3 sum(0);
    for (const glm::vec3& p : mesh.positions) sum += glm::dvec3(p);
    return sum / static_cast<double>(mesh.positions.size());
}

double farthest_from(const TriangleMesh& mesh, const glm::dvec3& point) {
    double farthest = 0;  // squared
#pragma omp parallel for schedule(static) reduction(max : farthest) if (mesh.positions.size() >= worth_threads)
    for (const glm::vec3& p : mesh.positions) {
        const glm::dvec3 apart = glm::dvec3(p) - point;
        farthest = std::max(farthest, glm::dot(apart, apart));
    }
    return std::sqrt(farthest);
}

// Does some corner take its normal from the faces around it?
bool lacks_normals(const TriangleMesh& mesh) {
    const auto lacks = [](const std::array<std::int32_t, 3>& corners) { return std::ranges::min(corners) < 0; };
    return mesh.normal_faces.empty() || std::ranges::any_of(mesh.normal_faces, lacks);
}

// Of each vertex, the mean of the unit normals of the faces around it as a unit vector; zero where it has no direction.
std::vector<glm::dvec3> vertex_directions(const TriangleMesh& mesh, const std::vector<glm::dvec3>& face_normals) {
    // In the order of the faces, on one thread: the same sums for any number of threads.
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (const std::uint32_t vertex : mesh.faces[f]) sums[vertex] += face_normals[f];
#pragma omp parallel for schedule(static) if (sums.size() >= worth_threads)
    for (glm::dvec3& sum : sums) {
        // Opposite faces cancel but for rounding: such a mean has no direction worth the name.
        sum = glm::length(sum) > 1e-9 ? direction_of(sum) : glm::dvec3(0);
    }
    return sums;
}

}  // namespace

std::vector<glm::vec3> placed_positions(const TriangleMesh& mesh, const glm::dvec3& center, double radius) {
    const glm::dvec3 mean = vertex_mean(mesh);
    const double scale = radius / farthest_from(mesh, mean);
    std::vector<glm::vec3> placed(mesh.positions.size());
#pragma omp parallel for schedule(static) if (placed.size() >= worth_threads)
    for (std::size_t i = 0; i < placed.size(); ++i)
        placed[i] = limited(center + (glm::dvec3(mesh.positions[i]) - mean) * scale);
    return placed;
}

void corner_normals(const TriangleMesh& mesh, std::span<VertexNormals> normals) {
    const std::size_t faces = mesh.faces.size();
    std::vector<glm::dvec3> face_normals(faces);
#pragma omp parallel for schedule(static) if (faces >= worth_threads)
    for (std::size_t f = 0; f < faces; ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        face_normals[f] = face_direction(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
    }
    if (lacks_normals(mesh)) {
        const std::vector<std::uint8_t> turned = faces_to_turn(mesh);
        for (std::size_t f = 0; f < turned.size(); ++f)
            if (turned[f] != 0) face_normals[f] = -face_normals[f];
    }
    const std::vector<glm::dvec3> of_vertex = vertex_directions(mesh, face_normals);
#pragma omp parallel for schedule(static) if (faces >= worth_threads)
    for (std::size_t f = 0; f < faces; ++f)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            glm::dvec3 n(0);
            if (!mesh.normal_faces.empty() && mesh.normal_faces[f][corner] >= 0)
                n = direction_of(mesh.normals[static_cast<std::size_t>(mesh.normal_faces[f][corner])]);
            if (n == glm::dvec3(0)) n = of_vertex[mesh.faces[f][corner]];
            if (n == glm::dvec3(0)) n = face_normals[f];
            if (n == glm::dvec3(0)) n = {0, 0, 1};
            for (int axis = 0; axis < 3; ++axis)
                normals[f].n[3 * corner + static_cast<std::size_t>(axis)] = static_cast<float>(n[axis]);
        }
}

std::vector<VertexNormals> corner_normals(const TriangleMesh& mesh) {
    std::vector<VertexNormals> normals(mesh.faces.size());
    corner_normals(mesh, normals);
    return normals;
}

glm::vec3 geometric_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 n = face_direction(a, b, c);
    return n == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(n);
}

}  // namespace raywalk
