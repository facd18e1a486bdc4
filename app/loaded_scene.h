// A scene read, compiled and ready to trace, with what that took.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>

#include "app/command_line/options.h"
#include "tracer/compiled/compile.h"
#include "tracer/rendering/renderer.h"
#include "tracer/scene/scene.h"

namespace raywalk {

struct LoadedScene {
    Scene scene;
    CompiledScene compiled;
    BuildStatistics build;
    // Of the scene file alone, of its meshes and images (at the same time), of all of it until it is ready.
    double read_seconds = 0, mesh_seconds = 0, image_seconds = 0, load_seconds = 0;
};

// Reads and compiles options.scene; prints warnings on stderr unless quiet. Throws InputError.
LoadedScene load_scene(const Options& options);

// The picture's size in pixels and its samples per pixel: the command line's, else the scene's (spec 4.3).
glm::ivec2 picture_size(const Options& options, const Scene& scene);
std::uint32_t samples_per_pixel(const Options& options, const Scene& scene);

// The view with which the program starts, before any of options.keys is pressed. `one_shot` where
// samples_per_pixel() is 1.
View opening_view(const Options& options, const Scene& scene);

}  // namespace raywalk
