// How often a test repeats itself.
#pragma once

#include "tracer/ground/sanitized.h"

namespace raywalk::test {

// `count`; under a sanitizer an eighth of it, so that a whole suite under one takes minutes.
constexpr int repetitions(int count) { return RAYWALK_SANITIZED && count >= 8 ? count / 8 : count; }

}  // namespace raywalk::test
