// One ray against sixteen boxes, triangles or spheres at a time. Hits at equal distance go to the lower shape id, so
// that it does not matter in which order shapes are tested, and both hierarchies give the same hit. Included once per
// target by Highway's foreach_target.h, hence the guard that toggles.

#if defined(RAYWALK_KERNELS_RAY_SHAPES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYWALK_KERNELS_RAY_SHAPES_H
#undef RAYWALK_KERNELS_RAY_SHAPES_H
#else
#define RAYWALK_KERNELS_RAY_SHAPES_H
#endif

#include <bit>

#include "tracer/kernels/ray_stream.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Which children the ray enters before t_max, and where.
HWY_INLINE Mask enter_children(const BvhNode& node, const SingleRay& ray, Real t_max, Real& entry) {
    const float* bounds = &node.lower[0][0];  // lower and upper lie side by side
    static_assert(offsetof(BvhNode, upper) == sizeof(float) * 3 * block_width);
    const RayStream& s = ray.stream;
    const auto near_t = [&](int a) HWY_ATTR {
        const Real bound = load(bounds + s.near_bound[a][ray.i]);
        return mul_sub(bound, Real(s.reciprocal[a][ray.i]), Real(s.near_offset[a][ray.i]));
    };
    const auto far_t = [&](int a) HWY_ATTR {
        const Real bound = load(bounds + ((3 + 2 * a) * block_width - s.near_bound[a][ray.i]));
        return mul_sub(bound, Real(s.reciprocal[a][ray.i]), Real(s.far_offset[a][ray.i]));
    };
    entry = max(max(near_t(0), near_t(1)), max(near_t(2), ray.t_min()));
    const Real exit = min(min(far_t(0), far_t(1)), min(far_t(2), t_max));
    return entry <= exit * Real(1.0f + 2 * slab_slack);
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
    const Vec3 direction = ray.direction();
    const Vec3 c = v0 - ray.origin(), q = cross(c, direction);
    const Real scale = Real(1.0f) / dot(normal, direction);
    TriangleLanes r;
    r.u = dot(q, e2) * scale;
    r.v = dot(q, e1) * scale;
    r.t = dot(normal, c) * scale;
    r.hit = (min(r.u, r.v) >= Real(-edge_slack)) & (r.u + r.v <= Real(1.0f + edge_slack)) & (r.t > ray.t_min()) &
            (r.t <= t_max);
    return r;
}

// By the closest approach of the ray to the centre, so that nothing cancels far away.
struct SphereLanes {
    Mask hit;
    Real t;
};
HWY_INLINE SphereLanes intersect_spheres(const SphereBlock& block, const SingleRay& ray, Real t_max) {
    const Vec3 direction = ray.direction();
    const Vec3 c = Vec3{load(block.center[0]), load(block.center[1]), load(block.center[2])} - ray.origin();
    const Real radius = load(block.radius), inverse_squared_length = Real(ray.stream.inverse_squared_length[ray.i]);
    const Real middle = dot(c, direction) * inverse_squared_length;
    const Vec3 p = c - direction * middle;
    const Real discriminant = radius * radius - dot(p, p);
    const Real half = sqrt(max(discriminant, Real(0.0f)) * inverse_squared_length);
    const Real first = middle - half;
    SphereLanes r;
    r.t = select(first > ray.t_min(), first, middle + half);
    r.hit = (discriminant >= Real(0.0f)) & (r.t > ray.t_min()) & (r.t <= t_max);
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

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#endif  // RAYWALK_KERNELS_RAY_SHAPES_H
