// Raywalk's own shading kernels over Embree's traversal, in a library of their own, so that the same names stand for
// two things in one program.
#pragma once

#include <embree3/rtcore.h>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/kernels.h"

namespace raywalk::bench {

// A scene whose triangles and spheres are asked of Embree, as geometries 0 and 1.
struct SceneOnEmbree : CompiledScene {
    RTCScene embree = nullptr;
};

// Their trace_tile must be given a SceneOnEmbree.
__attribute__((visibility("default"))) const Kernels* kernels_on_embree(std::string_view name);

}  // namespace raywalk::bench
