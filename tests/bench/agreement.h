// Whether two tracers found the same.
#pragma once

#include <string>

#include "tests/bench/ray_sets.h"

namespace raywalk::bench {

// Distances may differ by this much, relative to the distance and to the size of the scene, before the referee is
// asked.
inline constexpr float tolerated_distance = 1e-4f;

// Rays that graze an edge, a silhouette or the end of the ray may be decided either way by formulas that round
// differently: the referee tells them from wrong answers, of which none of ours may be.
struct Agreement {
    std::size_t rays = 0, different = 0;
    std::size_t wrong = 0;         // of ours, beyond rounding
    std::size_t theirs_wrong = 0;  // of theirs
    [[nodiscard]] bool good() const { return wrong == 0; }
};

// Rays agree when both hit nothing, the same shape, or something equally far away (shapes share edges).
Agreement compare(const Geometry& geometry, const RaySet& set, const HitBlocks& theirs, const HitBlocks& ours);

}  // namespace raywalk::bench
