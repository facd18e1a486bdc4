// One ray, alone, through either hierarchy.
#pragma once

#include <algorithm>

#include "tracer/kernels/traversal/ray_shapes.h"
#include "tracer/kernels/traversal/stack.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// What lies below `at`; true when an any-hit ray met something.
template <bool any_hit>
bool traverse_single(const CompiledScene& scene, const Bvh& bvh, BvhReference at, const SingleRay& ray, RayHit& hit) {
    const TriangleBlock* triangles = scene.hierarchy.triangle_blocks.data();
    const SphereBlock* spheres = scene.hierarchy.sphere_blocks.data();
    BvhStack stack;
    for (;;) {
        if (at.leaf()) {
            const bool done =
                at.spheres() ? visit_spheres<any_hit>(spheres + at.first(), at.blocks(), scene.triangle_count, ray, hit)
                             : visit_triangles<any_hit>(triangles + at.first(), at.blocks(), ray, hit);
            if (any_hit && done) return true;
        } else {
            const BvhNode& node = bvh.nodes[at.bits];
            Real entry;
            const std::uint32_t entered =
                bits(enter_children(child_sides(node, ray.stream, ray.i), ray, Real(hit.t), entry));
            if (stack.enter<!any_hit>(entered, entry, node.child, at)) continue;
        }
        if (!stack.leave(hit.t * (1.0f + slab_slack), at)) return false;
    }
}

template <bool any_hit>
bool traverse_single(const CompiledScene& scene, const KdTree& tree, const SingleRay& ray, RayHit& hit) {
    const Hierarchy& h = scene.hierarchy;
    KdInterval stack[KdTree::max_depth + 1];
    int depth = 0;

    float origin[3], reciprocal[3], padding[3];
    for (int a = 0; a < 3; ++a) {
        origin[a] = ray.stream.origin[a][ray.i];
        reciprocal[a] = ray.stream.reciprocal[a][ray.i];
        padding[a] = ray.stream.padding[a][ray.i];
    }
    // The part of the ray inside the tree's bounds.
    KdInterval at = {0, ray.stream.t_min[ray.i], hit.t};
    for (int a = 0; a < 3; ++a) {
        const float t0 = (h.bounds.lower[a] - origin[a]) * reciprocal[a],
                    t1 = (h.bounds.upper[a] - origin[a]) * reciprocal[a];
        at.enter = std::max(at.enter, std::min(t0, t1) - padding[a]);
        at.leave = std::min(at.leave, std::max(t0, t1) + padding[a]);
    }
    if (!(at.enter <= at.leave)) return false;

    for (;;) {
        KdNode node = tree.nodes[at.node];
        while (!node.leaf()) {
            const int axis = node.axis();
            const float t = (node.split - origin[axis]) * reciprocal[axis];
            const std::uint32_t lower = node.index();
            const std::uint32_t first = reciprocal[axis] > 0 ? lower : lower + 1;
            const std::uint32_t second = reciprocal[axis] > 0 ? lower + 1 : lower;
            const float t0 = t - padding[axis], t1 = t + padding[axis];
            if (t0 > at.leave) {
                at.node = first;
            } else if (t1 < at.enter) {
                at.node = second;
            } else {
                stack[depth++] = {second, std::max(at.enter, t0), at.leave};
                at = {first, at.enter, std::min(at.leave, t1)};
            }
            node = tree.nodes[at.node];
        }
        const KdLeaf& leaf = tree.leaves[node.index()];
        if (visit_triangles<any_hit>(h.triangle_blocks.data() + leaf.first_triangle_block, leaf.triangle_blocks, ray,
                                     hit) ||
            visit_spheres<any_hit>(h.sphere_blocks.data() + leaf.first_sphere_block, leaf.sphere_blocks,
                                   scene.triangle_count, ray, hit))
            return true;
        // Cells come front to back: once a hit lies before the next one, it is the nearest.
        if (depth == 0) return false;
        at = stack[--depth];
        if (at.enter * (1.0f - slab_slack) > hit.t) return false;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
