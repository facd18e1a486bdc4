#include "tracer/kernels/kernels.h"

#include <algorithm>
#include <vector>

#include "tracer/kernels/instruction_sets.h"
#include "tracer/kernels/tile_scratch.h"

namespace raywalk {

// Each is defined by kernel_table.cpp, compiled for its instruction set.
namespace N_AVX3 {
extern const Kernels kernels;
}
namespace N_AVX2 {
extern const Kernels kernels;
}
namespace N_SSE4 {
extern const Kernels kernels;
}
namespace N_SCALAR {
extern const Kernels kernels;
}

TileScratchPointer make_tile_scratch() { return TileScratchPointer(new TileScratch()); }
void TileScratchDeleter::operator()(TileScratch* scratch) const { delete scratch; }

namespace {

std::vector<const Kernels*> runnable_kernels() {
    const std::int64_t targets = runnable_targets();
    std::vector<const Kernels*> kernels;
    const auto add = [&](std::int64_t target, const Kernels& candidate) {
        if ((targets & target) != 0) kernels.push_back(&candidate);
    };
#ifdef RAYWALK_AVX512
    add(HWY_AVX3, N_AVX3::kernels);
#endif
#ifdef RAYWALK_AVX2
    add(HWY_AVX2, N_AVX2::kernels);
#endif
#ifdef RAYWALK_SSE4
    add(HWY_SSE4, N_SSE4::kernels);
#endif
    kernels.push_back(&N_SCALAR::kernels);
    (void)add;
    return kernels;
}

}  // namespace

std::span<const Kernels* const> available_kernels() {
    static const std::vector<const Kernels*> kernels = runnable_kernels();
    return kernels;
}

const Kernels* select_kernels(std::optional<std::string_view> name) {
    const auto kernels = available_kernels();
    if (!name) return kernels.front();
    const auto found = std::ranges::find(kernels, *name, &Kernels::name);
    return found == kernels.end() ? nullptr : *found;
}

}  // namespace raywalk
