// Sixteen shapes side by side: what a leaf of either hierarchy holds, and what one ray or beam is tested against.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "tracer/ground/aligned.h"

namespace raywalk {

inline std::uint32_t blocks_for(std::size_t shapes) { return static_cast<std::uint32_t>((shapes + lanes - 1) / lanes); }

// Expected cost of testing the shapes of a leaf, in blocks, for the surface-area heuristic of both hierarchies: mostly
// whole blocks, a little every shape, so that the cost still falls while a block empties. Whole frames of the BVH are
// 4 to 8 % faster than with costs in blocks of four.
inline double leaf_cost(std::uint32_t shapes) {
    const auto blocks = (shapes + lanes - 1) / lanes;
    return static_cast<double>(48 * blocks + shapes) / 64;
}

// corner[i][axis][lane]: corner i of the triangle in that lane. Empty lanes hold NaN and id -1: every comparison with
// a NaN is false, so they are never hit (hence no -ffast-math).
struct alignas(64) TriangleBlock {
    // Without values, as `= default` would not be where an array is made: arrays of blocks are filled by all threads.
    TriangleBlock() {}  // NOLINT(modernize-use-equals-default)
    float corner[3][3][lanes];
    std::int32_t id[lanes];  // triangle index, CompiledScene order
};

// Empty lanes hold a NaN centre, radius 0 and id -1.
struct alignas(64) SphereBlock {
    SphereBlock() {}  // NOLINT(modernize-use-equals-default)
    float center[3][lanes];
    float radius[lanes];
    std::int32_t id[lanes];  // sphere index (not yet offset by the triangle count)
};

inline void clear(TriangleBlock& block) {
    for (auto& corner : block.corner)
        for (auto& axis : corner)
            for (float& value : axis) value = std::numeric_limits<float>::quiet_NaN();
    for (std::int32_t& id : block.id) id = -1;
}

inline void clear(SphereBlock& block) {
    for (auto& axis : block.center)
        for (float& value : axis) value = std::numeric_limits<float>::quiet_NaN();
    for (float& radius : block.radius) radius = 0;
    for (std::int32_t& id : block.id) id = -1;
}

}  // namespace raywalk
