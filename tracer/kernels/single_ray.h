// One ray against sixteen boxes, triangles or spheres at a time, through either hierarchy: for rays that share neither
// origin nor direction. Hits at equal distance go to the lower shape id, so that both hierarchies give the same hit.
// Included once per target by Highway's foreach_target.h, hence the guard that toggles.

#if defined(RAYWALK_KERNELS_SINGLE_RAY_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYWALK_KERNELS_SINGLE_RAY_H
#undef RAYWALK_KERNELS_SINGLE_RAY_H
#else
#define RAYWALK_KERNELS_SINGLE_RAY_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/ground/vectors.h"
#include "tracer/kernels/ray_arrays.h"
#include "tracer/kernels/traversal_stack.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// A ray made ready. Plain numbers: they are spread over the lanes where they are used, which costs nothing, while
// keeping them spread would cost a kilobyte of stores for each ray.
struct SingleRay {
    float origin[3], direction[3];
    float inverse_squared_length;  // 1 / direction . direction
    float t_min;
    // Slabs: t = bound * reciprocal - near or far offset, boxes grown by the padding.
    float reciprocal[3], near_offset[3], far_offset[3];
    float padding[3];                 // in t
    int near_bound[3], far_bound[3];  // floats from the start of a BvhNode
};

// `padding`: what boxes are grown by, scene units.
HWY_INLINE SingleRay make_single_ray(const Ray& ray, float padding) {
    SingleRay s;
    float squared_length = 0;
    for (int a = 0; a < 3; ++a) {
        s.origin[a] = ray.origin[a];
        s.direction[a] = ray.direction[a];
        squared_length += ray.direction[a] * ray.direction[a];
        float d = ray.direction[a];
        if (!(std::fabs(d) >= smallest_direction)) d = std::copysign(smallest_direction, d);
        const float reciprocal = 1.0f / d;
        const float offset = ray.origin[a] * reciprocal;
        s.reciprocal[a] = reciprocal;
        s.padding[a] = padding * std::fabs(reciprocal);
        s.near_offset[a] = offset + s.padding[a];
        s.far_offset[a] = offset - s.padding[a];
        s.near_bound[a] = (d > 0 ? 0 : 3 * block_width) + a * block_width;
        s.far_bound[a] = (d > 0 ? 3 * block_width : 0) + a * block_width;
    }
    s.inverse_squared_length = 1.0f / squared_length;
    s.t_min = ray.t_min;
    return s;
}

// Which children the ray enters before t_max, and where.
HWY_INLINE std::uint32_t enter_children(const BvhNode& node, const SingleRay& ray, Real t_max, Real& entry) {
    const float* bounds = &node.lower[0][0];  // lower and upper lie side by side
    static_assert(offsetof(BvhNode, upper) == sizeof(float) * 3 * block_width);
    const auto near_t = [&](int a) HWY_ATTR {
        return mul_sub(load(bounds + ray.near_bound[a]), Real(ray.reciprocal[a]), Real(ray.near_offset[a]));
    };
    const auto far_t = [&](int a) HWY_ATTR {
        return mul_sub(load(bounds + ray.far_bound[a]), Real(ray.reciprocal[a]), Real(ray.far_offset[a]));
    };
    entry = max(max(near_t(0), near_t(1)), max(near_t(2), Real(ray.t_min)));
    const Real exit = min(min(far_t(0), far_t(1)), min(far_t(2), t_max));
    return bits(entry <= exit * Real(1.0f + 2 * slab_slack));
}

// Moeller and Trumbore, "Fast, minimum storage ray-triangle intersection" (1997), on sixteen triangles.
struct TriangleLanes {
    Mask hit;
    Real t, u, v;
};
HWY_INLINE TriangleLanes intersect_triangles(const TriangleBlock& block, const SingleRay& ray, Real t_max) {
    const Vec3 v0 = {load(block.corner[0][0]), load(block.corner[0][1]), load(block.corner[0][2])};
    const Vec3 v1 = {load(block.corner[1][0]), load(block.corner[1][1]), load(block.corner[1][2])};
    const Vec3 v2 = {load(block.corner[2][0]), load(block.corner[2][1]), load(block.corner[2][2])};
    const Vec3 e1 = v0 - v1, e2 = v2 - v0, normal = cross(e2, e1);
    const Vec3 direction = splat3(ray.direction);
    const Vec3 c = v0 - splat3(ray.origin), q = cross(c, direction);
    const Real scale = Real(1.0f) / dot(normal, direction);
    TriangleLanes r;
    r.u = dot(q, e2) * scale;
    r.v = dot(q, e1) * scale;
    r.t = dot(normal, c) * scale;
    r.hit = (min(r.u, r.v) >= Real(-edge_slack)) & (r.u + r.v <= Real(1.0f + edge_slack)) & (r.t > Real(ray.t_min)) &
            (r.t <= t_max);
    return r;
}

// By the closest approach of the ray to the centre, so that nothing cancels far away.
struct SphereLanes {
    Mask hit;
    Real t;
};
HWY_INLINE SphereLanes intersect_spheres(const SphereBlock& block, const SingleRay& ray, Real t_max) {
    const Vec3 direction = splat3(ray.direction);
    const Vec3 c = Vec3{load(block.center[0]), load(block.center[1]), load(block.center[2])} - splat3(ray.origin);
    const Real radius = load(block.radius), inverse_squared_length = Real(ray.inverse_squared_length);
    const Real middle = dot(c, direction) * inverse_squared_length;
    const Vec3 p = c - direction * middle;
    const Real discriminant = radius * radius - dot(p, p);
    const Real half = sqrt(max(discriminant, Real(0.0f)) * inverse_squared_length);
    const Real first = middle - half;
    SphereLanes r;
    r.t = select(first > Real(ray.t_min), first, middle + half);
    r.hit = (discriminant >= Real(0.0f)) & (r.t > Real(ray.t_min)) & (r.t <= t_max);
    return r;
}

// Takes the nearest of the lanes that hit (seldom more than one), if it is nearer than `hit` or as near with a lower
// id. Returns its lane, or -1.
HWY_INLINE int take_nearest(std::uint32_t lanes_hit, Real t, const std::int32_t* ids, std::int32_t first_id,
                            RayHit& hit) {
    HWY_ALIGN float distance[lanes];
    store(t, distance);
    int taken = -1;
    for (; lanes_hit != 0; lanes_hit &= lanes_hit - 1) {
        const int l = std::countr_zero(lanes_hit);
        const std::int32_t id = first_id + ids[l];
        if (distance[l] > hit.t || (distance[l] == hit.t && id >= hit.id)) continue;
        hit.t = distance[l];
        hit.id = id;
        taken = l;
    }
    return taken;
}

// Tests the blocks of a leaf; true when an any-hit ray is done.
template <bool any_hit>
HWY_INLINE bool visit_triangles(const TriangleBlock* block, std::uint32_t blocks, const SingleRay& ray, RayHit& hit) {
    for (const TriangleBlock* end = block + blocks; block != end; ++block) {
        const TriangleLanes found = intersect_triangles(*block, ray, Real(hit.t));
        const std::uint32_t lanes_hit = bits(found.hit);
        if (lanes_hit == 0) continue;
        if constexpr (any_hit) return true;
        const int l = take_nearest(lanes_hit, found.t, block->id, 0, hit);
        if (l >= 0) hit.u = lane(found.u, l), hit.v = lane(found.v, l);
    }
    return false;
}

template <bool any_hit>
HWY_INLINE bool visit_spheres(const SphereBlock* block, std::uint32_t blocks, std::int32_t first_id,
                              const SingleRay& ray, RayHit& hit) {
    for (const SphereBlock* end = block + blocks; block != end; ++block) {
        const SphereLanes found = intersect_spheres(*block, ray, Real(hit.t));
        const std::uint32_t lanes_hit = bits(found.hit);
        if (lanes_hit == 0) continue;
        if constexpr (any_hit) return true;
        if (take_nearest(lanes_hit, found.t, block->id, first_id, hit) >= 0) hit.u = hit.v = 0;
    }
    return false;
}

template <bool any_hit>
bool traverse_single(const CompiledScene& scene, const Bvh& bvh, const SingleRay& ray, RayHit& hit) {
    const TriangleBlock* triangles = scene.hierarchy.triangle_blocks.data();
    const SphereBlock* spheres = scene.hierarchy.sphere_blocks.data();
    BvhStack stack;
    BvhReference at = BvhReference::inner(0);
    for (;;) {
        if (at.leaf()) {
            const bool done =
                at.spheres() ? visit_spheres<any_hit>(spheres + at.first(), at.blocks(), scene.triangle_count, ray, hit)
                             : visit_triangles<any_hit>(triangles + at.first(), at.blocks(), ray, hit);
            if (any_hit && done) return true;
        } else {
            const BvhNode& node = bvh.nodes[at.bits];
            Real entry;
            const std::uint32_t entered = enter_children(node, ray, Real(hit.t), entry);
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

    // The part of the ray inside the tree's bounds.
    KdInterval at = {0, ray.t_min, hit.t};
    for (int a = 0; a < 3; ++a) {
        const float t0 = (h.bounds.lower[a] - ray.origin[a]) * ray.reciprocal[a],
                    t1 = (h.bounds.upper[a] - ray.origin[a]) * ray.reciprocal[a];
        at.enter = std::max(at.enter, std::min(t0, t1) - ray.padding[a]);
        at.leave = std::min(at.leave, std::max(t0, t1) + ray.padding[a]);
    }
    if (!(at.enter <= at.leave)) return false;

    for (;;) {
        KdNode node = tree.nodes[at.node];
        while (!node.leaf()) {
            const int axis = node.axis();
            const float t = (node.split - ray.origin[axis]) * ray.reciprocal[axis];
            const std::uint32_t lower = node.index();
            const std::uint32_t first = ray.reciprocal[axis] > 0 ? lower : lower + 1;
            const std::uint32_t second = ray.reciprocal[axis] > 0 ? lower + 1 : lower;
            const float t0 = t - ray.padding[axis], t1 = t + ray.padding[axis];
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

#endif  // RAYWALK_KERNELS_SINGLE_RAY_H
