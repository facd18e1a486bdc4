#include "tests/bench/kernels_on_embree.h"

namespace raywalk::bench {

const Kernels* kernels_on_embree(std::string_view name) { return select_kernels(name); }

}  // namespace raywalk::bench
