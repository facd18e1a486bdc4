// What --stats writes.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/loaded_scene.h"
#include "tracer/rendering/renderer.h"

namespace raywalk {

// Scene counts, load and build times, tree statistics, and of the renderer so far: rays by kind, rays per second of
// `trace_seconds`, threads, instruction set, dropped samples. A walk adds its frame times under "frames".
nlohmann::ordered_json statistics_of(const Options& options, const LoadedScene& loaded, const Renderer& renderer,
                                     double trace_seconds);

// To stdout for "-", else to the file, whole or not at all. Throws WorkError.
void write_statistics(const std::filesystem::path& file, const nlohmann::ordered_json& statistics);

}  // namespace raywalk
