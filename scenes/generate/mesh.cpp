#include "scenes/generate/mesh.h"

#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>

namespace generate {
namespace {

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

void append(std::string& text, float value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, 5).ptr;
    text.append(digits, end);
}

void append(std::string& text, const char* keyword, const glm::vec3& v) {
    text += keyword;
    for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        append(text, v[axis]);
    }
    text += '\n';
}

}  // namespace

Edges count_edges(const Mesh& mesh) {
    std::unordered_map<std::uint64_t, int> directed;
    directed.reserve(mesh.faces.size() * 3);
    for (const auto& face : mesh.faces)
        for (int i = 0; i < 3; ++i) ++directed[edge_key(face[i], face[(i + 1) % 3])];

    Edges edges;
    std::unordered_map<std::uint32_t, std::uint32_t> next;  // along the boundary
    for (const auto& [key, count] : directed) {
        const auto from = static_cast<std::uint32_t>(key >> 32), to = static_cast<std::uint32_t>(key);
        if (count > 1) ++edges.crowded;
        if (!directed.contains(edge_key(to, from))) {
            ++edges.open;
            next[to] = from;
        }
    }
    while (!next.empty()) {
        ++edges.boundary_loops;
        for (auto at = next.begin(); at != next.end();) {
            const std::uint32_t to = at->second;
            next.erase(at);
            at = next.find(to);
        }
    }
    return edges;
}

Mesh welded(const Mesh& mesh, float tolerance) {
    std::map<std::tuple<long, long, long>, std::uint32_t> places;
    std::vector<std::uint32_t> renamed(mesh.positions.size());
    Mesh result;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3& p = mesh.positions[i];
        const auto [place, is_new] = places.try_emplace(
            {std::lround(p.x / tolerance), std::lround(p.y / tolerance), std::lround(p.z / tolerance)},
            static_cast<std::uint32_t>(result.positions.size()));
        renamed[i] = place->second;
        if (!is_new) continue;
        result.positions.push_back(p);
        if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[i]);
    }
    for (const auto& face : mesh.faces) {
        const std::array corners = {renamed[face[0]], renamed[face[1]], renamed[face[2]]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            result.faces.push_back(corners);
    }
    return result;
}

std::string obj_text(const Mesh& mesh, std::string_view about) {
    std::string text = "# " + std::string(about) + "\n# " + std::to_string(mesh.positions.size()) + " vertices, " +
                       std::to_string(mesh.faces.size()) + " triangles\n";
    text.reserve(mesh.positions.size() * 64 + mesh.faces.size() * 45);
    for (const glm::vec3& p : mesh.positions) append(text, "v", p);
    for (const glm::vec3& n : mesh.normals) append(text, "vn", n);
    for (const auto& face : mesh.faces) {
        text += 'f';
        for (const std::uint32_t corner : face) {
            const std::string index = std::to_string(corner + 1);
            text += ' ' + index;
            if (!mesh.normals.empty()) text += "//" + index;
        }
        text += '\n';
    }
    return text;
}

}  // namespace generate
