// Whether two tracers found the same.
#pragma once

#include <string>

#include "tests/bench/ray_sets.h"

namespace raywalk::bench {

// Rays that graze an edge or a silhouette may be decided either way by formulas that round differently; no more than
// this share of the rays may be.
inline constexpr double tolerated_share = 1e-4;
// Distances may differ by this much, relative to the distance and to the size of the scene.
inline constexpr float tolerated_distance = 1e-4f;

struct Agreement {
    std::size_t rays = 0, different = 0;
    [[nodiscard]] double share() const {
        return rays == 0 ? 0 : static_cast<double>(different) / static_cast<double>(rays);
    }
    [[nodiscard]] bool good() const { return share() <= tolerated_share; }
};

// Rays agree when both hit nothing, the same shape, or something equally far away (shapes share edges).
Agreement compare(const RaySet& set, const HitArrays& a, const HitArrays& b);

}  // namespace raywalk::bench
