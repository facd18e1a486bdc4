// What a traversal still has to visit, nearest on top.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "tracer/compiled/hierarchy.h"
#include "tracer/kernels/lanes/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// A kd-tree node and the part of the ray (t) or beam (depth) inside its cell.
struct KdInterval {
    std::uint32_t node;
    float enter, leave;
};

// Asks for the memory of children that will be visited, of nodes and first blocks. Fine meshes are larger than the near
// caches, and memory comes while other children are visited.
HWY_INLINE void fetch_children(const Hierarchy& h, const Bvh& bvh, const BvhNode& node, std::uint32_t entered) {
    constexpr std::size_t cache_line = 64;
    for (; entered != 0; entered &= entered - 1) {
        const BvhReference child = {node.child[std::countr_zero(entered)]};
        const void* memory = bvh.nodes.data() + child.bits;
        if (child.leaf()) memory = h.triangle_blocks.data() + child.first();
        if (child.leaf() && child.spheres()) memory = h.sphere_blocks.data() + child.first();
        // The largest of the three; to ask for more than there is does no harm.
        for (std::size_t at = 0; at < sizeof(TriangleBlock); at += cache_line)
            __builtin_prefetch(static_cast<const char*>(memory) + at);
    }
}

// BVH children by entry distance: one 64-bit key each, bits of the distance (>= 0, so ordered as integers) above the
// reference.
class BvhStack {
  public:
    // Goes on to the nearest of the entered children and keeps the others; false when none is entered. Unordered
    // (for rays that take any hit) it goes to the first.
    template <bool ordered>
    HWY_INLINE bool enter(std::uint32_t entered, Real entry, const std::uint32_t* child, BvhReference& at) {
        if (entered == 0) return false;
        const int first = std::countr_zero(entered);
        entered &= entered - 1;
        if (entered == 0) {
            at.bits = child[first];
            return true;
        }
        HWY_ALIGN float distance[lanes];
        store(entry, distance);
        const auto key = [&](int l) HWY_ATTR {
            return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(distance[l])) << 32 | child[l];
        };
        if constexpr (!ordered) {
            for (; entered != 0; entered &= entered - 1) keys_[size_++] = key(std::countr_zero(entered));
            at.bits = child[first];
            return true;
        }
        const int second = std::countr_zero(entered);
        entered &= entered - 1;
        const std::uint64_t a = key(first), b = key(second);
        const int base = size_;
        keys_[size_++] = std::max(a, b);
        std::uint64_t nearest = std::min(a, b);
        for (; entered != 0; entered &= entered - 1) {
            const std::uint64_t k = key(std::countr_zero(entered));
            std::uint64_t farther = std::max(k, nearest);
            nearest = std::min(k, nearest);
            int i = size_++;
            for (; i > base && keys_[i - 1] < farther; --i) keys_[i] = keys_[i - 1];
            keys_[i] = farther;
        }
        at.bits = static_cast<std::uint32_t>(nearest);
        return true;
    }

    // The nearest child kept, farther ones than `limit` (>= 0) dropped; false when none is left.
    HWY_INLINE bool leave(float limit, BvhReference& at) {
        while (size_ > 0) {
            const std::uint64_t key = keys_[--size_];
            if (std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32)) <= limit) {
                at.bits = static_cast<std::uint32_t>(key);
                return true;
            }
        }
        return false;
    }

  private:
    std::uint64_t keys_[(Bvh::max_depth + 1) * (lanes - 1)];
    int size_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
