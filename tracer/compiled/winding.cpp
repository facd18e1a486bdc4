#include "tracer/compiled/winding.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

namespace raywalk {

namespace {

constexpr std::uint32_t none = 0xFFFF'FFFFu;

// The edge from corner `k` of a face is number 3 * face + k.
constexpr std::size_t most_faces = none / 3;

std::uint32_t start_of(const TriangleMesh& mesh, std::uint32_t edge) { return mesh.faces[edge / 3][edge % 3]; }
std::uint32_t end_of(const TriangleMesh& mesh, std::uint32_t edge) {
    return mesh.faces[edge / 3][edge % 3 == 2 ? 0 : edge % 3 + 1];
}
std::uint32_t opposite_of(const TriangleMesh& mesh, std::uint32_t edge) {
    return mesh.faces[edge / 3][edge % 3 == 0 ? 2 : edge % 3 - 1];
}

bool is_degenerate(const std::array<std::uint32_t, 3>& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

// The finalizer of MurmurHash3: no sums of its values cancel but by design.
std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x85EB'CA6Bu;
    x ^= x >> 13;
    x *= 0xC2B2'AE35u;
    return x ^ x >> 16;
}

// By vertex, 1 if the faces around it may not agree. Where they do, and surround it, each neighbour is the next of one
// and the previous of another: a sum over the neighbours is 0. So is that of one face alone taken to be.
std::vector<std::uint8_t> doubtful_vertices(const TriangleMesh& mesh) {
    struct Around {
        std::uint32_t sum = 0, faces = 0;
    };
    std::vector<Around> around(mesh.positions.size());
    for (const auto& face : mesh.faces) {
        const std::uint32_t hashes[3] = {hash(face[0]), hash(face[1]), hash(face[2])};
        for (std::size_t i = 0; i < 3; ++i) {
            Around& here = around[face[i]];
            here.sum += hashes[(i + 1) % 3] - hashes[(i + 2) % 3];
            ++here.faces;
        }
    }
    std::vector<std::uint8_t> doubtful(around.size());
    for (std::size_t v = 0; v < around.size(); ++v) doubtful[v] = around[v].sum != 0 && around[v].faces > 1 ? 1 : 0;
    return doubtful;
}

// The edges of faces that are no line, if both their vertices are among `vertices` (all, if that is empty): uses of one
// edge follow one another. First by the lower vertex, in linear time, then by the other.
std::vector<std::uint32_t> edges_in_order(const TriangleMesh& mesh, const std::vector<std::uint8_t>& vertices) {
    const auto counts = [&](std::uint32_t v) { return vertices.empty() || vertices[v] != 0; };
    const auto for_each_edge = [&](const auto& visit) {
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            if (is_degenerate(mesh.faces[f])) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto edge = static_cast<std::uint32_t>(3 * f + k);
                const std::uint32_t a = start_of(mesh, edge), b = end_of(mesh, edge);
                if (counts(a) && counts(b)) visit(edge, std::min(a, b));
            }
        }
    };
    std::vector<std::uint32_t> places(mesh.positions.size() + 1);
    for_each_edge([&](std::uint32_t, std::uint32_t lower) { ++places[lower + 1]; });
    for (std::size_t v = 1; v < places.size(); ++v) places[v] += places[v - 1];
    std::vector<std::uint32_t> edges(places.back());
    for_each_edge([&](std::uint32_t edge, std::uint32_t lower) { edges[places[lower]++] = edge; });

    const auto higher = [&](std::uint32_t edge) { return std::max(start_of(mesh, edge), end_of(mesh, edge)); };
    for (std::size_t v = 0, begin = 0; v + 1 < places.size(); begin = places[v++])
        std::sort(edges.begin() + static_cast<std::ptrdiff_t>(begin),
                  edges.begin() + static_cast<std::ptrdiff_t>(places[v]),
                  [&](std::uint32_t a, std::uint32_t b) { return std::pair(higher(a), a) < std::pair(higher(b), b); });
    return edges;
}

// Calls visit(edge, other) for each edge that two faces share. Not where they are the same face twice.
template <class Visit>
void for_each_shared_edge(const TriangleMesh& mesh, const std::vector<std::uint32_t>& edges, const Visit& visit) {
    const auto ends = [&](std::uint32_t edge) {
        const std::uint32_t a = start_of(mesh, edge), b = end_of(mesh, edge);
        return std::pair(std::min(a, b), std::max(a, b));
    };
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && ends(edges[end]) == ends(edges[i])) ++end;
        if (end - i == 2 && opposite_of(mesh, edges[i]) != opposite_of(mesh, edges[i + 1]))
            visit(edges[i], edges[i + 1]);
        i = end;
    }
}

bool same_direction(const TriangleMesh& mesh, std::uint32_t edge, std::uint32_t other) {
    return start_of(mesh, edge) == start_of(mesh, other);
}

bool agrees(const TriangleMesh& mesh) {
    const std::vector<std::uint8_t> doubtful = doubtful_vertices(mesh);
    if (std::ranges::find(doubtful, 1) == doubtful.end()) return true;
    bool good = true;
    for_each_shared_edge(mesh, edges_in_order(mesh, doubtful), [&](std::uint32_t edge, std::uint32_t other) {
        if (same_direction(mesh, edge, other)) good = false;
    });
    return good;
}

// Six times the volume that a part of the mesh encloses, negative where its faces point inwards.
double enclosed(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part,
                const std::vector<std::uint8_t>& turned) {
    const glm::dvec3 from(mesh.positions[mesh.faces[part[0]][0]]);
    double sum = 0;
    for (const std::uint32_t f : part) {
        const auto at = [&](std::size_t i) { return glm::dvec3(mesh.positions[mesh.faces[f][i]]) - from; };
        const double volume = glm::dot(at(0), glm::cross(at(1), at(2)));
        sum += turned[f] != 0 ? -volume : volume;
    }
    return sum;
}

}  // namespace

std::vector<std::uint8_t> faces_to_turn(const TriangleMesh& mesh) {
    if (mesh.faces.size() > most_faces || agrees(mesh)) return {};
    std::vector<std::uint32_t> across(3 * mesh.faces.size(), none);  // by edge, that of the other face
    for_each_shared_edge(mesh, edges_in_order(mesh, {}), [&](std::uint32_t edge, std::uint32_t other) {
        across[edge] = other;
        across[other] = edge;
    });

    std::vector<std::uint8_t> turned(mesh.faces.size()), reached(mesh.faces.size());
    std::vector<std::uint32_t> part;
    for (std::uint32_t first = 0; first < mesh.faces.size(); ++first) {
        if (reached[first] != 0) continue;
        part = {first};
        reached[first] = 1;
        bool closed = true;
        std::size_t turns = 0;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const std::uint32_t face = part[i];
            for (std::uint32_t edge = 3 * face; edge < 3 * face + 3; ++edge) {
                const std::uint32_t other = across[edge];
                if (other == none) closed = false;
                if (other == none || reached[other / 3] != 0) continue;
                reached[other / 3] = 1;
                turned[other / 3] = turned[face] ^ (same_direction(mesh, edge, other) ? 1 : 0);
                turns += turned[other / 3];
                part.push_back(other / 3);
            }
        }
        if (turns == 0) continue;
        const double volume = closed ? enclosed(mesh, part, turned) : 0;
        if (volume < 0 || (volume == 0 && 2 * turns > part.size()))
            for (const std::uint32_t face : part) turned[face] ^= 1;
    }
    return turned;
}

}  // namespace raywalk
