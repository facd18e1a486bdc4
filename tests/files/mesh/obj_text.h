// OBJ files written out in a test, and what the reader makes of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/files/scene_text.h"
#include "tracer/files/mesh/obj_reader.h"

namespace raywalk {

using Corners = std::array<std::uint32_t, 3>;
using NormalCorners = std::array<std::int32_t, 3>;

// Four vertices, two normals.
inline constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvt 0 0\n";

// A mesh, and what was said of it.
struct ReadMesh {
    TriangleMesh mesh = {};
    std::vector<Diagnostic> warnings = {};
    std::string text = {};  // the warnings, and the error if there is one

    explicit ReadMesh(std::string_view obj, const Limits& limits = {}) {
        std::string error;
        try {
            mesh = parse_obj(obj, "x.obj", limits, warnings);
        } catch (const InputError& thrown) {
            error = thrown.what();
        }
        for (const Diagnostic& d : warnings) text += to_string(d) + "\n";
        text += error;
    }
};

inline TriangleMesh triangles_of(std::string_view obj, const Limits& limits = {}) {
    std::vector<Diagnostic> warnings;
    return parse_obj(obj, "x.obj", limits, warnings);
}

inline std::string said_of_mesh(std::string_view obj, const Limits& limits = {}) { return ReadMesh(obj, limits).text; }

}  // namespace raywalk
