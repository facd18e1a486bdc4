#include "tracer/files/mesh/obj_flaws.h"

#include <algorithm>
#include <utility>

namespace raywalk {

namespace {

// What flaws of a kind cost: one, and several of them.
struct Cost {
    std::string_view one, several;
};

constexpr Cost face_cost = {"1 face is left out", "faces are left out"};

// By kind.
constexpr std::array<Cost, obj_flaw_kinds> costs = {{
    {"1 line is ignored", "lines are ignored"},
    {"1 vertex cannot be read", "vertices cannot be read"},
    {"1 weight or colour is ignored", "weights or colours are ignored"},
    {"1 normal cannot be read", "normals cannot be read"},
    {"1 normal has no length", "normals have no length"},
    face_cost,
    face_cost,
    face_cost,
    face_cost,
    {"1 corner is read in part", "corners are read in part"},
    {"1 corner gets its normal from the faces around it", "corners get their normals from the faces around them"},
}};

std::string cost_of(ObjFlaw kind, std::size_t count) {
    const Cost& cost = costs[static_cast<std::size_t>(kind)];
    if (count == 1) return std::string(cost.one);
    return std::to_string(count) + " " + std::string(cost.several);
}

}  // namespace

void ObjFlaws::append(ObjFlaws& of_piece, std::size_t lines_before) {
    for (std::size_t kind = 0; kind < obj_flaw_kinds; ++kind) {
        Found& piece = of_piece.found_[kind];
        if (piece.count > 0 && found_[kind].count == 0) {
            found_[kind].first = std::move(piece.first);
            found_[kind].first.line += lines_before;
        }
        found_[kind].count += piece.count;
    }
}

void ObjFlaws::clear() {
    for (Found& found : found_) found.count = 0;
}

std::vector<Diagnostic> ObjFlaws::warnings(const std::string& file, std::size_t vertices, std::size_t normals) const {
    std::vector<Diagnostic> result;
    for (std::size_t kind = 0; kind < obj_flaw_kinds; ++kind) {
        const auto& [count, first] = found_[kind];
        if (count == 0) continue;
        const auto flaw = static_cast<ObjFlaw>(kind);
        std::string expected = first.expected;
        if (expected.empty() && flaw == ObjFlaw::no_vertex)
            expected = "the file has " + std::to_string(vertices) + (vertices == 1 ? " vertex" : " vertices");
        if (expected.empty() && flaw == ObjFlaw::no_normal)
            expected = "the file has " + std::to_string(normals) + (normals == 1 ? " normal" : " normals");
        Diagnostic d = warning_at({file, first.line + 1, first.column, first.length},
                                  first.what + (first.what.empty() ? "" : ": ") + cost_of(flaw, count), expected);
        quote_line(d, first.source_line);
        result.push_back(std::move(d));
    }
    std::ranges::stable_sort(result, {}, [](const Diagnostic& d) { return std::pair(d.where.line, d.where.column); });
    return result;
}

}  // namespace raywalk
