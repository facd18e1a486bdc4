#include "tracer/files/mesh/polygons.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "tracer/files/mesh/ear_clipping.h"

namespace raywalk {

namespace {

// Runs of fewer polygons are looked at by one thread: waking the others takes longer, and there may be many runs.
constexpr std::size_t worth_threads = 65'536;

glm::dvec3 twice_area_vector(const TriangleMesh& mesh, std::size_t face) {
    const auto& [a, b, c] = mesh.faces[face];
    const glm::dvec3 at_a(mesh.positions[a]);
    return glm::cross(glm::dvec3(mesh.positions[b]) - at_a, glm::dvec3(mesh.positions[c]) - at_a);
}

// Does one of the triangles lie the wrong way round, by more than rounding may have turned it?
bool leaves_polygon(const TriangleMesh& mesh, std::size_t first_face, std::size_t triangles) {
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < triangles; ++i) sum += twice_area_vector(mesh, first_face + i);
    const double size = glm::length(sum);
    if (!(size > 0)) return false;  // without an inside
    const glm::dvec3 normal = sum / size;
    double least = 0;
    for (std::size_t i = 0; i < triangles; ++i)
        least = std::min(least, glm::dot(twice_area_vector(mesh, first_face + i), normal));
    // Most polygons are told by the first test: what is wrong by a millionth of the polygon nobody sees.
    if (least >= -1e-6 * size) return false;
    const glm::dvec3 first(mesh.positions[mesh.faces[first_face][0]]);
    double largest = std::max({std::abs(first.x), std::abs(first.y), std::abs(first.z)}), reach = 0;
    for (std::size_t i = 0; i < triangles; ++i)
        for (const std::uint32_t corner : mesh.faces[first_face + i])
            reach = std::max(reach, glm::length(glm::dvec3(mesh.positions[corner]) - first));
    largest += reach;
    return least < -0x1p-22 * largest * reach;
}

// Quads, the most frequent by far: both triangles on the same side is enough.
bool quad_leaves_polygon(const TriangleMesh& mesh, std::size_t first_face) {
    const auto& [a, b, c] = mesh.faces[first_face];
    const glm::vec3 at_a = mesh.positions[a], diagonal = mesh.positions[c] - at_a;
    const glm::vec3 first = glm::cross(mesh.positions[b] - at_a, diagonal);
    const glm::vec3 second = glm::cross(diagonal, mesh.positions[mesh.faces[first_face + 1][2]] - at_a);
    return !(glm::dot(first, second) > 0) && leaves_polygon(mesh, first_face, 2);
}

bool is_wrong(const TriangleMesh& mesh, const PolygonRun& run, std::size_t polygon) {
    const std::size_t triangles = run.corners - 2;
    const std::size_t first_face = run.first_face + polygon * triangles;
    return triangles == 2 ? quad_leaves_polygon(mesh, first_face) : leaves_polygon(mesh, first_face, triangles);
}

std::size_t count_wrong(const TriangleMesh& mesh, const PolygonRun& run) {
    std::size_t wrong = 0;
#pragma omp parallel for schedule(static) reduction(+ : wrong) if (run.count >= worth_threads)
    for (std::size_t i = 0; i < run.count; ++i) wrong += is_wrong(mesh, run, i) ? 1 : 0;
    return wrong;
}

// Puts `triangles` of a polygon's corners where its fan is.
template <class Corners>
void replace_fan(std::span<Corners> fan, std::span<const EarClipper::Triangle> triangles, std::vector<Corners>& kept) {
    kept.assign(fan.begin(), fan.end());
    const auto corner = [&](std::uint32_t i) { return i < 2 ? kept[0][i] : kept[i - 2][2]; };
    for (std::size_t f = 0; f < fan.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) fan[f][i] = corner(triangles[f][i]);
}

// What a mesh may ask for: a second or two, and what its own size is worth.
std::uint64_t steps_for(const TriangleMesh& mesh) { return 1'000'000'000 + 1000 * std::uint64_t{mesh.faces.size()}; }

}  // namespace

void PolygonRuns::append(const PolygonRuns& of_chunk, std::size_t faces_before) {
    for (const PolygonRun& run : of_chunk.runs_) add({run.first_face + faces_before, run.count, run.corners});
}

std::size_t cut_concave_polygons(TriangleMesh& mesh, const PolygonRuns& polygons) {
    EarClipper clipper(steps_for(mesh));
    std::vector<glm::vec3> corners;
    std::vector<std::array<std::uint32_t, 3>> fan;
    std::vector<std::array<std::int32_t, 3>> normal_fan;
    std::size_t not_cut = 0;
    for (const PolygonRun& run : polygons.runs()) {
        if (count_wrong(mesh, run) == 0) continue;
        const std::size_t triangles = run.corners - 2;
        for (std::size_t polygon = 0; polygon < run.count; ++polygon) {
            if (!is_wrong(mesh, run, polygon)) continue;
            const std::span faces(mesh.faces.data() + run.first_face + polygon * triangles, triangles);
            corners = {mesh.positions[faces[0][0]], mesh.positions[faces[0][1]]};
            for (const auto& face : faces) corners.push_back(mesh.positions[face[2]]);
            const auto cut = clipper.cut(corners);
            if (cut.empty()) {
                ++not_cut;
                continue;
            }
            replace_fan(faces, cut, fan);
            if (mesh.normal_faces.empty()) continue;
            const std::size_t first = static_cast<std::size_t>(faces.data() - mesh.faces.data());
            replace_fan(std::span(mesh.normal_faces.data() + first, triangles), cut, normal_fan);
        }
    }
    return not_cut;
}

}  // namespace raywalk
