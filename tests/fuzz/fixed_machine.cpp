// A machine that is always the same one, so that findings can be reproduced on any.
#include "app/process/cores.h"
#include "tracer/kernels/kernels.h"

namespace raywalk {

int usable_cores() { return 4; }

std::span<const Kernels* const> available_kernels() {
    static const Kernels kernels = [] {
        Kernels one{};
        one.name = "avx2";
        return one;
    }();
    static const Kernels* const all[] = {&kernels};
    return all;
}

}  // namespace raywalk
