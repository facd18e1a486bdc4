// Up to 64 rays through the BVH together: each node and leaf is read once for all rays that enter it, and their tests,
// which do not wait for each other, fill the machine. After Barringer and Akenine-Moeller, "Dynamic ray stream
// traversal" (2014). Which rays go together never shows in what they hit.
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

#include "tracer/kernels/traversal/single_ray.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

HWY_INLINE RayHit hit_of(const HitPacket& hits, int i) { return {hits.t[i], hits.u[i], hits.v[i], hits.id[i]}; }
HWY_INLINE void set_hit(const RayHit& hit, int i, HitPacket& hits) {
    hits.t[i] = hit.t;
    hits.u[i] = hit.u;
    hits.v[i] = hit.v;
    hits.id[i] = hit.id;
}

// A node or leaf still to be visited, and by which rays.
struct StreamVisit {
    std::uint64_t rays;
    BvhReference at;
    float entry;  // where the first of them enters
};

class StreamStack {
  public:
    [[nodiscard]] HWY_INLINE bool empty() const { return size_ == 0; }
    HWY_INLINE StreamVisit pop() { return visits_[--size_]; }
    // Below those pushed since `base` that are entered earlier.
    HWY_INLINE void push(const StreamVisit& visit, int base) {
        int i = size_++;
        for (; i > base && visits_[i - 1].entry < visit.entry; --i) visits_[i] = visits_[i - 1];
        visits_[i] = visit;
    }
    [[nodiscard]] HWY_INLINE int size() const { return size_; }

  private:
    StreamVisit visits_[(Bvh::max_depth + 1) * lanes];
    int size_ = 0;
};

// All rays that rise and fall along the same axes as ray i.
HWY_INLINE std::uint64_t octant_of(const RayStream& rays, int i) {
    std::uint64_t octant = ~std::uint64_t{0};
    for (const std::uint64_t rises : rays.rises) octant &= (rises >> i & 1) != 0 ? rises : ~rises;
    return octant;
}

// Sends the rays to the children that they enter, the nearest on top. Octant by octant, so that the sides of the boxes
// are read once for many rays: what a test reads is what it takes.
HWY_INLINE void visit_node(const CompiledScene& scene, const Bvh& bvh, BvhReference at, std::uint64_t active,
                           const RayStream& rays, const HitPacket& hits, StreamStack& stack) {
    const BvhNode& node = bvh.nodes[at.bits];
    HWY_ALIGN std::int32_t entered[packet_size];  // by ray: which children
    HWY_ALIGN float first_entry[lanes];           // by child
    std::uint32_t children = 0;
    Real nearest = Real(std::numeric_limits<float>::infinity());
    for (std::uint64_t rest = active; rest != 0;) {
        const int first = std::countr_zero(rest);
        const ChildSides sides = child_sides(node, rays, first);
        std::uint64_t octant = rest & octant_of(rays, first);
        rest &= ~octant;
        for (; octant != 0; octant &= octant - 1) {
            const int i = std::countr_zero(octant);
            Real entry;
            const Mask enters = enter_children(sides, {rays, i}, Real(hits.t[i]), entry);
            nearest = select(enters, min(nearest, entry), nearest);
            const std::uint32_t own = bits(enters);
            entered[i] = static_cast<std::int32_t>(own);
            children |= own;
        }
    }
    store(nearest, first_entry);
    fetch_children(scene.hierarchy, bvh, node, children);
    const int base = stack.size();
    for (; children != 0; children &= children - 1) {
        const int child = std::countr_zero(children);
        const Int bit(std::int32_t{1} << child);
        std::uint64_t enterers = 0;
        for (int g = 0; g < packet_groups; ++g) enterers |= rays_of((load(entered + g * lanes) & bit) == bit, g);
        stack.push({enterers & active, {node.child[child]}, first_entry[child]}, base);
    }
}

// What the rays of a stream found in one block, before each takes its nearest: in this order no ray's test waits for
// another's outcome.
struct BlockHits {
    alignas(64) float t[packet_size][lanes], u[packet_size][lanes], v[packet_size][lanes];
    std::uint32_t lanes_hit[packet_size];
    int ray[packet_size];
};

// Of triangles or spheres, ids counted from first_id; returns the any-hit rays that are done.
template <bool any_hit, class Block>
HWY_INLINE std::uint64_t visit_block(const Block& block, std::int32_t first_id, std::uint64_t active,
                                     const RayStream& rays, HitPacket& hits) {
    constexpr bool has_weights = std::is_same_v<Block, TriangleBlock>;
    BlockHits found;
    int count = 0;
    std::uint64_t done = 0;
    for (; active != 0; active &= active - 1) {
        const int i = std::countr_zero(active);
        const auto met = meet_block(block, {rays, i});
        const std::uint32_t lanes_hit = bits(met.hit & within<any_hit>(met.t, Real(hits.t[i])));
        if constexpr (any_hit) {
            done |= static_cast<std::uint64_t>(lanes_hit != 0) << i;
        } else {
            store(met.t, found.t[count]);
            if constexpr (has_weights) {
                store(met.u, found.u[count]);
                store(met.v, found.v[count]);
            }
            found.lanes_hit[count] = lanes_hit;
            found.ray[count] = i;
            count += lanes_hit != 0;
        }
    }
    for (int n = 0; n < count; ++n) {
        const int i = found.ray[n];
        RayHit hit = hit_of(hits, i);
        const int l = take_nearest(found.lanes_hit[n], load(found.t[n]), block.id, first_id, hit);
        if (l < 0) continue;
        hit.u = has_weights ? found.u[n][l] : 0;
        hit.v = has_weights ? found.v[n][l] : 0;
        set_hit(hit, i, hits);
    }
    return done;
}

// Tests the blocks of a leaf; returns the any-hit rays that are done.
template <bool any_hit>
HWY_INLINE std::uint64_t visit_leaf(const CompiledScene& scene, BvhReference leaf, std::uint64_t active,
                                    const RayStream& rays, HitPacket& hits) {
    std::uint64_t done = 0;
    for (std::uint32_t i = leaf.first(), end = i + leaf.blocks(); i != end; ++i)
        done |= leaf.spheres()
                    ? visit_block<any_hit>(scene.hierarchy.sphere_blocks[i], scene.triangle_count, active & ~done, rays,
                                           hits)
                    : visit_block<any_hit>(scene.hierarchy.triangle_blocks[i], 0, active & ~done, rays, hits);
    return done;
}

// Returns which any-hit rays met something; `hits` holds for each ray what is known already, at first t_max.
template <bool any_hit>
std::uint64_t traverse_stream(const CompiledScene& scene, const Bvh& bvh, std::uint64_t active, const RayStream& rays,
                              HitPacket& hits) {
    StreamStack stack;
    stack.push({active, BvhReference::inner(0), 0}, 0);
    std::uint64_t done = 0;
    while (!stack.empty()) {
        const StreamVisit visit = stack.pop();
        const std::uint64_t visitors = visit.rays & ~done;
        if (visitors == 0) continue;
        if (std::has_single_bit(visitors)) {  // it goes on alone
            const int i = std::countr_zero(visitors);
            RayHit hit = hit_of(hits, i);
            if (traverse_single<any_hit>(scene, bvh, visit.at, {rays, i}, hit)) done |= visitors;
            if constexpr (!any_hit) set_hit(hit, i, hits);
        } else if (visit.at.leaf()) {
            done |= visit_leaf<any_hit>(scene, visit.at, visitors, rays, hits);
        } else {
            visit_node(scene, bvh, visit.at, visitors, rays, hits, stack);
        }
    }
    return done;
}

template <bool any_hit>
std::uint64_t traverse_stream(const CompiledScene& scene, const KdTree& tree, std::uint64_t active,
                              const RayStream& rays, HitPacket& hits) {
    std::uint64_t done = 0;
    for (; active != 0; active &= active - 1) {
        const int i = std::countr_zero(active);
        RayHit hit = hit_of(hits, i);
        if (traverse_single<any_hit>(scene, tree, {rays, i}, hit)) done |= std::uint64_t{1} << i;
        if constexpr (!any_hit) set_hit(hit, i, hits);
    }
    return done;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
