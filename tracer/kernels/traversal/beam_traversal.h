// A beam through either hierarchy.
#pragma once

#include <algorithm>

#include "tracer/kernels/traversal/beam_shapes.h"
#include "tracer/kernels/traversal/stack.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// What a beam asks of sixteen child boxes: four sides of the frustum and the depth interval, one multiply-add each.
struct BeamSlabs {
    int near_bound, far_bound;  // along k: floats from the start of a BvhNode
    int lower_a, upper_a, lower_b, upper_b;
    Real sign, near_offset, far_offset;
    // A box reaches the slope u1 where its lower side is at most origin + u1 * depth, at its farthest depth if u1
    // rises, at its nearest if it falls; and so on for the other three.
    Real u0, u1, v0, v1;
    Real a_low, a_high, b_low, b_high;  // origin, padding included
    Mask u0_rises, u1_rises, v0_rises, v1_rises;
};

HWY_INLINE BeamSlabs make_beam_slabs(const Beam& beam) {
    BeamSlabs s;
    const bool forward = beam.sign > 0;
    s.near_bound = (forward ? 0 : 3 * lanes) + beam.k * lanes;
    s.far_bound = (forward ? 3 * lanes : 0) + beam.k * lanes;
    s.lower_a = beam.a * lanes;
    s.upper_a = (3 + beam.a) * lanes;
    s.lower_b = beam.b * lanes;
    s.upper_b = (3 + beam.b) * lanes;
    s.sign = Real(beam.sign);
    s.near_offset = Real(beam.rays->origin[beam.k] * beam.sign + beam.padding);
    s.far_offset = Real(beam.rays->origin[beam.k] * beam.sign - beam.padding);
    s.u0 = Real(beam.u0), s.u1 = Real(beam.u1), s.v0 = Real(beam.v0), s.v1 = Real(beam.v1);
    s.a_low = Real(beam.rays->origin[beam.a] - beam.padding), s.a_high = Real(beam.rays->origin[beam.a] + beam.padding);
    s.b_low = Real(beam.rays->origin[beam.b] - beam.padding), s.b_high = Real(beam.rays->origin[beam.b] + beam.padding);
    s.u0_rises = s.u0 >= Real(0.0f), s.u1_rises = s.u1 >= Real(0.0f);
    s.v0_rises = s.v0 >= Real(0.0f), s.v1_rises = s.v1 >= Real(0.0f);
    return s;
}

HWY_INLINE std::uint32_t enter_children(const BvhNode& node, const BeamSlabs& s, const Beam& beam, Real& entry) {
    const float* bounds = &node.lower[0][0];  // lower and upper lie side by side
    const Real depth_min = Real(beam.depth_min);
    const Real near_z = max(mul_sub(load(bounds + s.near_bound), s.sign, s.near_offset), depth_min);
    const Real far_z = mul_sub(load(bounds + s.far_bound), s.sign, s.far_offset);
    entry = near_z;
    Mask keep = (far_z >= depth_min) & (near_z <= Real(beam.depth_max));
    keep &= load(bounds + s.lower_a) <= mul_add(s.u1, select(s.u1_rises, far_z, near_z), s.a_high);
    keep &= load(bounds + s.upper_a) >= mul_add(s.u0, select(s.u0_rises, near_z, far_z), s.a_low);
    keep &= load(bounds + s.lower_b) <= mul_add(s.v1, select(s.v1_rises, far_z, near_z), s.b_high);
    keep &= load(bounds + s.upper_b) >= mul_add(s.v0, select(s.v0_rises, near_z, far_z), s.b_low);
    return bits(keep);
}

// Any-hit beams end when no ray is left, all when their tests are used up.
template <bool any_hit>
HWY_INLINE bool beam_done(const Beam& beam) {
    return (any_hit && beam.active == 0) || beam.tests_left < 0;
}

template <bool any_hit>
void traverse_beam(const CompiledScene& scene, const Bvh& bvh, Beam& beam) {
    const BeamSlabs slabs = make_beam_slabs(beam);
    BvhStack stack;
    BvhReference at = BvhReference::inner(0);
    for (;;) {
        if (at.leaf()) {
            for (std::uint32_t i = at.first(), end = i + at.blocks(); i != end && !beam_done<any_hit>(beam); ++i) {
                if (at.spheres())
                    beam_spheres<any_hit>(scene.hierarchy.sphere_blocks[i], beam.rays->origin, scene.triangle_count,
                                          beam);
                else
                    beam_triangles<any_hit>(scene.hierarchy.triangle_blocks[i], beam.rays->origin, beam);
            }
            if (beam_done<any_hit>(beam)) return;
        } else {
            const BvhNode& node = bvh.nodes[at.bits];
            Real entry;
            const std::uint32_t entered = enter_children(node, slabs, beam, entry);
            fetch_children(scene.hierarchy, bvh, node, entered);
            if (stack.enter<true>(entered, entry, node.child, at)) continue;
        }
        if (!stack.leave(beam.depth_max, at)) return;
    }
}

// Depths at which a beam crosses a plane at distance x (signed, from the origin along an axis): x * r0 for its first
// ray, x * r1 for its last; infinite where rays never cross it.
struct PlaneCrossing {
    float r0, r1;
};

// `ahead`: for planes at positive x.
HWY_INLINE PlaneCrossing plane_crossing(float slope0, float slope1, bool ahead) {
    if (ahead) return {slope1 > 0 ? 1.0f / slope1 : infinity, slope0 > 0 ? 1.0f / slope0 : infinity};
    return {slope0 < 0 ? 1.0f / slope0 : -infinity, slope1 < 0 ? 1.0f / slope1 : -infinity};
}

template <bool any_hit>
void traverse_beam(const CompiledScene& scene, const KdTree& tree, Beam& beam) {
    const Hierarchy& h = scene.hierarchy;
    PlaneCrossing crossing[3][2];
    for (int ahead = 0; ahead < 2; ++ahead) {
        crossing[beam.a][ahead] = plane_crossing(beam.u0, beam.u1, ahead != 0);
        crossing[beam.b][ahead] = plane_crossing(beam.v0, beam.v1, ahead != 0);
        crossing[beam.k][ahead] = plane_crossing(beam.sign, beam.sign, ahead != 0);
    }

    KdInterval stack[KdTree::max_depth + 1];
    int depth = 0;
    const float low = (h.bounds.lower[beam.k] - beam.rays->origin[beam.k]) * beam.sign;
    const float high = (h.bounds.upper[beam.k] - beam.rays->origin[beam.k]) * beam.sign;
    KdInterval at = {0, std::max(beam.depth_min, std::min(low, high) - beam.padding),
                     std::min(beam.depth_max, std::max(low, high) + beam.padding)};
    if (!(at.enter <= at.leave)) return;

    for (;;) {
        KdNode node = tree.nodes[at.node];
        while (!node.leaf()) {
            const int axis = node.axis();
            const float x = node.split - beam.rays->origin[axis];
            const bool ahead = x > 0;
            const std::uint32_t lower = node.index();
            const std::uint32_t near_child = ahead ? lower : lower + 1, far_child = ahead ? lower + 1 : lower;
            if (std::fabs(x) <= beam.padding) {
                // The origin is as good as in the plane: both sides are ahead.
                stack[depth++] = {far_child, at.enter, at.leave};
                at.node = near_child;
            } else {
                const PlaneCrossing c = crossing[axis][ahead];
                const float z0 = (ahead ? x - beam.padding : x + beam.padding) * c.r0 * (1.0f - slab_slack);
                const float z1 = (ahead ? x + beam.padding : x - beam.padding) * c.r1 * (1.0f + slab_slack);
                if (z0 > at.leave) {
                    at.node = near_child;
                } else if (z1 < at.enter) {
                    at.node = far_child;
                } else {
                    stack[depth++] = {far_child, std::max(at.enter, z0), at.leave};
                    at = {near_child, at.enter, std::min(at.leave, z1)};
                }
            }
            node = tree.nodes[at.node];
        }
        const KdLeaf& leaf = tree.leaves[node.index()];
        for (std::uint32_t i = 0; i < leaf.triangle_blocks; ++i) {
            beam_triangles<any_hit>(h.triangle_blocks[leaf.first_triangle_block + i], beam.rays->origin, beam);
            if (beam_done<any_hit>(beam)) return;
        }
        for (std::uint32_t i = 0; i < leaf.sphere_blocks; ++i) {
            beam_spheres<any_hit>(h.sphere_blocks[leaf.first_sphere_block + i], beam.rays->origin, scene.triangle_count,
                                  beam);
            if (beam_done<any_hit>(beam)) return;
        }
        do {
            if (depth == 0) return;
            at = stack[--depth];
        } while (at.enter > beam.depth_max);
        at.leave = std::min(at.leave, beam.depth_max);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
