#include "scenes/generate/surface_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

namespace generate {
namespace {

struct Grid {
    glm::vec3 lower;
    float step;
    glm::ivec3 nodes;  // along each axis

    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(nodes.x) * static_cast<std::size_t>(nodes.y) *
               static_cast<std::size_t>(nodes.z);
    }
    [[nodiscard]] std::size_t index(const glm::ivec3& at) const {
        return static_cast<std::size_t>(at.x) +
               static_cast<std::size_t>(nodes.x) * (static_cast<std::size_t>(at.y) +
                                                    static_cast<std::size_t>(nodes.y) * static_cast<std::size_t>(at.z));
    }
    [[nodiscard]] glm::vec3 position(const glm::ivec3& at) const { return lower + step * glm::vec3(at); }
};

glm::vec3 gradient(const Field& field, const glm::vec3& p, float width) {
    glm::vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 more = p, less = p;
        more[axis] += width;
        less[axis] -= width;
        result[axis] = (field(more) - field(less)) / (more[axis] - less[axis]);
    }
    return result;
}

// The twelve edges of a cube by number: 4 * axis + where it stands along the two axes after its own (two bits).
constexpr int edge_number(int axis, int first, int second) { return 4 * axis + first + 2 * second; }

// The grid nodes at both ends of an edge of the cube whose lowest corner is `cell`.
std::array<glm::ivec3, 2> ends(const glm::ivec3& cell, int edge) {
    const int axis = edge / 4;
    glm::ivec3 low = cell;
    low[(axis + 1) % 3] += edge & 1;
    low[(axis + 2) % 3] += edge >> 1 & 1;
    glm::ivec3 high = low;
    ++high[axis];
    return {low, high};
}

// How the surface passes through one cube: for each edge the lowest numbered edge of the same sheet, -1 where the edge
// is not crossed. Sheets are kept apart, so that a saddle that touches a cube twice makes no edge of four faces.
std::array<int, 12> sheets(const Grid& grid, const std::vector<float>& values, const glm::ivec3& cell) {
    std::array<int, 12> sheet;
    for (int edge = 0; edge < 12; ++edge) {
        const auto [low, high] = ends(cell, edge);
        sheet[edge] = (values[grid.index(low)] < 0) != (values[grid.index(high)] < 0) ? edge : -1;
    }
    const auto join = [&](int a, int b) {
        const int keep = std::min(sheet[a], sheet[b]), drop = std::max(sheet[a], sheet[b]);
        std::replace(sheet.begin(), sheet.end(), drop, keep);
    };
    for (int normal = 0; normal < 3; ++normal)
        for (int side = 0; side < 2; ++side) {
            const int a = (normal + 1) % 3, b = (normal + 2) % 3;
            // Edges of this face: along a the axes after are (b, normal), along b they are (normal, a).
            const auto along_a = [&](int j) { return edge_number(a, j, side); };
            const auto along_b = [&](int i) { return edge_number(b, side, i); };
            std::array<int, 4> crossed;
            int count = 0;
            for (const int edge : {along_a(0), along_a(1), along_b(0), along_b(1)})
                if (sheet[edge] >= 0) crossed[count++] = edge;
            if (count == 2) join(crossed[0], crossed[1]);
            if (count < 4) continue;
            for (int i = 0; i < 2; ++i)  // two opposite corners are inside: cut each off by itself
                for (int j = 0; j < 2; ++j) {
                    glm::ivec3 corner = cell;
                    corner[normal] += side;
                    corner[a] += i;
                    corner[b] += j;
                    if (values[grid.index(corner)] < 0) join(along_a(j), along_b(i));
                }
        }
    return sheet;
}

// Mean of the points where one sheet crosses the edges of a cube.
glm::vec3 mean_crossing(const Grid& grid, const std::vector<float>& values, const glm::ivec3& cell,
                        const std::array<int, 12>& sheet, int which) {
    glm::vec3 sum{0};
    int crossings = 0;
    for (int edge = 0; edge < 12; ++edge) {
        if (sheet[edge] != which) continue;
        const auto [low, high] = ends(cell, edge);
        const float at_low = values[grid.index(low)], at_high = values[grid.index(high)];
        sum += grid.position(low);
        sum[edge / 4] += grid.step * at_low / (at_low - at_high);
        ++crossings;
    }
    return sum / static_cast<float>(crossings);
}

// Moves every vertex towards the mean of its neighbours, along the surface only, and back onto the surface.
void relax(const Field& field, float step, int rounds, Mesh& mesh) {
    const auto count = static_cast<std::ptrdiff_t>(mesh.positions.size());
    mesh.normals.resize(mesh.positions.size());
    std::vector<glm::vec3> sums(mesh.positions.size());
    std::vector<float> weights(mesh.positions.size());
    for (int round = 0; round <= rounds; ++round) {
        std::fill(sums.begin(), sums.end(), glm::vec3(0));
        std::fill(weights.begin(), weights.end(), 0.0f);
        for (const auto& face : mesh.faces)
            for (int i = 0; i < 3; ++i) {
                sums[face[i]] += mesh.positions[face[(i + 1) % 3]] + mesh.positions[face[(i + 2) % 3]];
                weights[face[i]] += 2;
            }
#pragma omp parallel for
        for (std::ptrdiff_t i = 0; i < count; ++i) {
            glm::vec3& p = mesh.positions[i];
            if (round > 0) {
                const glm::vec3 pull = 0.5f * (sums[i] / weights[i] - p);
                p += pull - glm::dot(pull, mesh.normals[i]) * mesh.normals[i];
            }
            for (int newton = 0; newton < 2; ++newton) {
                const glm::vec3 slope = gradient(field, p, 0.05f * step);
                const glm::vec3 move = slope * (field(p) / glm::dot(slope, slope));
                p -= move * std::min(1.0f, 0.5f * step / std::max(glm::length(move), 1e-12f));
            }
            mesh.normals[i] = glm::normalize(gradient(field, p, 0.05f * step));
        }
    }
}

}  // namespace

Mesh surface_nets(const Field& field, const glm::vec3& lower, const glm::vec3& upper, float step) {
    const Grid grid{lower, step, glm::ivec3(glm::ceil((upper - lower) / step)) + 1};
    std::vector<float> values(grid.count());
#pragma omp parallel for schedule(dynamic)
    for (int z = 0; z < grid.nodes.z; ++z)
        for (int y = 0; y < grid.nodes.y; ++y)
            for (int x = 0; x < grid.nodes.x; ++x) values[grid.index({x, y, z})] = field(grid.position({x, y, z}));

    Mesh mesh;
    std::unordered_map<std::size_t, std::uint32_t> vertices;  // by 12 * cell + sheet
    const auto vertex = [&](const glm::ivec3& cell, int edge) {
        const std::array<int, 12> sheet = sheets(grid, values, cell);
        const auto [entry, is_new] = vertices.try_emplace(grid.index(cell) * 12 + static_cast<std::size_t>(sheet[edge]),
                                                          static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(mean_crossing(grid, values, cell, sheet, sheet[edge]));
        return entry->second;
    };
    for (int z = 1; z < grid.nodes.z - 1; ++z)
        for (int y = 1; y < grid.nodes.y - 1; ++y)
            for (int x = 1; x < grid.nodes.x - 1; ++x)
                for (int axis = 0; axis < 3; ++axis) {
                    const glm::ivec3 here{x, y, z};
                    glm::ivec3 ahead = here;
                    ++ahead[axis];
                    const bool inside = values[grid.index(here)] < 0;
                    if (inside == (values[grid.index(ahead)] < 0)) continue;
                    glm::ivec3 du{0}, dv{0};
                    du[(axis + 1) % 3] = 1;
                    dv[(axis + 2) % 3] = 1;
                    std::array quad = {
                        vertex(here - du - dv, edge_number(axis, 1, 1)), vertex(here - dv, edge_number(axis, 0, 1)),
                        vertex(here, edge_number(axis, 0, 0)), vertex(here - du, edge_number(axis, 1, 0))};
                    if (!inside) std::swap(quad[1], quad[3]);
                    const auto& p = mesh.positions;
                    if (glm::distance(p[quad[0]], p[quad[2]]) < glm::distance(p[quad[1]], p[quad[3]])) {
                        mesh.faces.push_back({quad[0], quad[1], quad[2]});
                        mesh.faces.push_back({quad[0], quad[2], quad[3]});
                    } else {
                        mesh.faces.push_back({quad[0], quad[1], quad[3]});
                        mesh.faces.push_back({quad[1], quad[2], quad[3]});
                    }
                }
    relax(field, step, 4, mesh);
    return mesh;
}

}  // namespace generate
