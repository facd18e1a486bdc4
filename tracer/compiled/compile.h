// From a scene and its files to what the kernels read.
#pragma once

#include <vector>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/error.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

namespace raywalk {

struct CompileStatistics {
    double mesh_seconds = 0, image_seconds = 0, total_seconds = 0;
    BuildStatistics build;
};

struct CompileOptions {
    Accelerator accelerator = Accelerator::bvh;  // builds and traces whole frames faster; hits are the same
    KdOptions kd;
};

// Opens the scene's meshes and images, places the meshes, builds the hierarchy. Throws InputError.
CompiledScene compile(const Scene& scene, const CompileOptions& options, const Limits& limits,
                      std::vector<Diagnostic>& warnings, CompileStatistics* statistics = nullptr);

}  // namespace raywalk
