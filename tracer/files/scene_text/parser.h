// Scene text -> Scene (spec 3). Every mistake of the file is reported in one run.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

namespace raywalk {

// Reads and validates a scene file; throws InputError with all its mistakes. Meshes and images are not opened.
// Warnings (never errors) are appended to `warnings`.
Scene read_scene(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings);

// The same for text already in memory; `file` names it in messages and is the base of relative paths.
Scene parse_scene(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                  std::vector<Diagnostic>& warnings);

}  // namespace raywalk
