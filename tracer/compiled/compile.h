// From a scene and its assets to what the kernels read.
#pragma once

#include "tracer/compiled/compiled_scene.h"
#include "tracer/files/load.h"
#include "tracer/scene/scene.h"

namespace raywalk {

struct CompileOptions {
    Accelerator accelerator = Accelerator::bvh;  // builds and traces whole frames faster; hits are the same
    KdOptions kd;
};

// Places the meshes and builds the hierarchy: opens no file. `assets` are the scene's; their memory is taken as it is
// used.
CompiledScene compile(const Scene& scene, Assets assets, const CompileOptions& options,
                      BuildStatistics* statistics = nullptr);

}  // namespace raywalk
