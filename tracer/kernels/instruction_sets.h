// Which instruction sets this processor, and the system on it, can run. Highway's own SupportedTargets says the same,
// but its library measures a clock while it is loaded, a third of the time until main; a test compares the two.
#pragma once

#include <cpuid.h>

#include <cstdint>

#include "hwy/detect_targets.h"

namespace raywalk {

// Of HWY_SSE4, HWY_AVX2 and HWY_AVX3, those whose every instruction can be run: the lists of Highway's
// set_macros-inl.h.
inline std::int64_t runnable_targets() {
    if (!(__builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
          __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes")))
        return 0;
    unsigned a = 0, b = 0, c = 0, d = 0;
    const bool half_floats = __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
    if (!(half_floats && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2")))
        return HWY_SSE4;
    if (!(__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")))
        return HWY_SSE4 | HWY_AVX2;
    return HWY_SSE4 | HWY_AVX2 | HWY_AVX3;
}

}  // namespace raywalk
