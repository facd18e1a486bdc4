// Writes shapes into the lanes of leaf blocks.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/compiled/hierarchy.h"

namespace raywalk {

// Fills blocks_for(ids.size()) blocks from `blocks` on with the triangles ids[i]; empty lanes are cleared.
inline void fill_blocks(TriangleBlock* blocks, std::span<const std::uint32_t> ids,
                        std::span<const TriangleCorners> triangles) {
    if (ids.size() % lanes != 0) clear(blocks[ids.size() / lanes]);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        TriangleBlock& block = blocks[i / lanes];
        const std::size_t lane = i % lanes;
        const TriangleCorners& triangle = triangles[ids[i]];
        for (int corner = 0; corner < 3; ++corner)
            for (int axis = 0; axis < 3; ++axis) block.corner[corner][axis][lane] = triangle.p[corner][axis];
        block.id[lane] = static_cast<std::int32_t>(ids[i]);
    }
}

// The same for spheres; `ids` count from `first_id`.
inline void fill_blocks(SphereBlock* blocks, std::span<const std::uint32_t> ids, std::span<const SphereShape> spheres,
                        std::uint32_t first_id) {
    if (ids.size() % lanes != 0) clear(blocks[ids.size() / lanes]);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        SphereBlock& block = blocks[i / lanes];
        const std::size_t lane = i % lanes;
        const SphereShape& sphere = spheres[ids[i] - first_id];
        for (int axis = 0; axis < 3; ++axis) block.center[axis][lane] = sphere.center[axis];
        block.radius[lane] = sphere.radius;
        block.id[lane] = static_cast<std::int32_t>(ids[i] - first_id);
    }
}

}  // namespace raywalk
