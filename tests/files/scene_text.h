// Scenes written out in a test, and what the parser says of them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/files/scene_text/parser.h"

namespace raywalk {

namespace fs = std::filesystem;

inline constexpr std::string_view viewer = "Viewer\ngeo 64 48\ncenter 0 0 0\ntarget 0 0 -1\nup 0 1 0\nfovy 45\n";
inline constexpr std::string_view light = "Light\norigin 0 5 0\ncolor WHITE\nintensity 1\n";
inline constexpr std::string_view sphere = "Sphere\ntexture PureTexture PLASTIC RED\ncenter 0 0 -5\nradius 1\n";

inline Scene parse(std::string_view text, const fs::path& file = "x.scene", const Limits& limits = {}) {
    std::vector<Diagnostic> warnings;
    return parse_scene(text, file, limits, warnings);
}

inline std::string said_of(std::string_view text, const fs::path& file = "x.scene", const Limits& limits = {}) {
    try {
        parse(text, file, limits);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

inline bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace raywalk
