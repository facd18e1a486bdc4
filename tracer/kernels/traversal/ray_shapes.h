// One ray against sixteen boxes, triangles or spheres at a time. Hits at equal distance go to the lower shape id, so
// that it does not matter in which order shapes are tested, and both hierarchies give the same hit.
#pragma once

#include <bit>

#include "tracer/kernels/traversal/ray_stream.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// The sides of a node's sixteen child boxes that rays of one octant meet first and last.
struct ChildSides {
    Real near_side[3], far_side[3];
};
HWY_INLINE ChildSides child_sides(const BvhNode& node, const RayStream& rays, int i) {
    const float* bounds = &node.lower[0][0];  // lower and upper lie side by side
    static_assert(offsetof(BvhNode, upper) == sizeof(float) * 3 * lanes);
    ChildSides sides;
    for (int a = 0; a < 3; ++a) {
        const std::int32_t near_bound = rays.near_bound[a][i];
        sides.near_side[a] = load(bounds + near_bound);
        sides.far_side[a] = load(bounds + ((3 + 2 * a) * lanes - near_bound));
    }
    return sides;
}

// Which children the ray enters before t_max, and where.
HWY_INLINE Mask enter_children(const ChildSides& sides, const SingleRay& ray, Real t_max, Real& entry) {
    const RayStream& s = ray.stream;
    const auto near_t = [&](int a) HWY_ATTR {
        return mul_sub(sides.near_side[a], Real(s.reciprocal[a][ray.i]), Real(s.near_offset[a][ray.i]));
    };
    const auto far_t = [&](int a) HWY_ATTR {
        return mul_sub(sides.far_side[a], Real(s.reciprocal[a][ray.i]), Real(s.far_offset[a][ray.i]));
    };
    entry = max(max(near_t(0), near_t(1)), max(near_t(2), ray.t_min()));
    const Real exit = min(min(far_t(0), far_t(1)), min(far_t(2), t_max));
    return entry <= exit * Real(1.0f + 2 * slab_slack);
}

// Moeller and Trumbore, "Fast, minimum storage ray-triangle intersection" (1997), with all that does not depend on the
// direction d drawn together: the weights of corners 1 and 2 are u . d / normal . d and v . d / normal . d, the
// distance is volume / normal . d.
struct TriangleForms {
    Vec3 normal, u, v;
    Real volume;
    Real spread;  // edge times distance, by their largest coordinates: what the rounding of u and v goes with
};
HWY_INLINE Real largest_coordinate(Vec3 a) { return max(max(abs(a.x), abs(a.y)), abs(a.z)); }
HWY_INLINE TriangleForms triangle_forms(const TriangleBlock& block, Vec3 origin) {
    const Vec3 v0 = {load(block.corner[0][0]), load(block.corner[0][1]), load(block.corner[0][2])};
    const Vec3 v1 = {load(block.corner[1][0]), load(block.corner[1][1]), load(block.corner[1][2])};
    const Vec3 v2 = {load(block.corner[2][0]), load(block.corner[2][1]), load(block.corner[2][2])};
    const Vec3 e1 = v0 - v1, e2 = v2 - v0, c = v0 - origin;
    TriangleForms f;
    f.normal = cross(e2, e1);
    f.u = cross(e2, c);
    f.v = cross(e1, c);
    f.volume = dot(f.normal, c);
    const Real edge = max(largest_coordinate(e1), largest_coordinate(e2));
    f.spread = edge * (edge + largest_coordinate(c));
    return f;
}

// Sixteen triangles and one ray, or one triangle and sixteen rays: either way the same bits.
struct TriangleLanes {
    Mask hit;  // nothing said of any limit
    Real t, u, v;
};
HWY_INLINE TriangleLanes meet_triangles(const TriangleForms& f, Vec3 direction, Real growth, Real t_min) {
    const Real scale = Real(1.0f) / dot(f.normal, direction);
    TriangleLanes r;
    r.u = dot(f.u, direction) * scale;
    r.v = dot(f.v, direction) * scale;
    r.t = f.volume * scale;
    const Real slack = min(f.spread * growth * abs(scale), Real(most_growth));
    r.hit = (min(r.u, r.v) >= -slack) & (r.u + r.v <= Real(1.0f) + slack) & (r.t > t_min);
    return r;
}

// By the closest approach of the ray to the centre, so that nothing cancels far away. `center`: from the ray's origin.
struct SphereLanes {
    Mask hit;  // nothing said of any limit
    Real t;
};
HWY_INLINE SphereLanes meet_spheres(Vec3 center, Real radius, Vec3 direction, Real inverse_squared_length, Real t_min) {
    const Real middle = dot(center, direction) * inverse_squared_length;
    const Vec3 p = center - direction * middle;
    const Real discriminant = radius * radius - dot(p, p);
    const Real half = sqrt(max(discriminant, Real(0.0f)) * inverse_squared_length);
    const Real first = middle - half;
    SphereLanes r;
    r.t = select(first > t_min, first, middle + half);
    r.hit = (discriminant >= Real(0.0f)) & (r.t > t_min);
    return r;
}

HWY_INLINE Vec3 sphere_centers(const SphereBlock& block, Vec3 origin) {
    return Vec3{load(block.center[0]), load(block.center[1]), load(block.center[2])} - origin;
}

// A ray against all shapes of a block.
HWY_INLINE TriangleLanes meet_block(const TriangleBlock& block, const SingleRay& ray) {
    return meet_triangles(triangle_forms(block, ray.origin()), ray.direction(), Real(ray.stream.growth[ray.i]),
                          ray.t_min());
}
HWY_INLINE SphereLanes meet_block(const SphereBlock& block, const SingleRay& ray) {
    return meet_spheres(sphere_centers(block, ray.origin()), load(block.radius), ray.direction(),
                        Real(ray.stream.inverse_squared_length[ray.i]), ray.t_min());
}

// Nearest-hit rays also look at hits as far as the one they have: a lower id wins.
template <bool any_hit>
HWY_INLINE Mask within(Real t, Real limit) {
    return any_hit ? t < limit : t <= limit;
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
        const TriangleLanes found = meet_block(*block, ray);
        const std::uint32_t lanes_hit = bits(found.hit & within<any_hit>(found.t, Real(hit.t)));
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
        const SphereLanes found = meet_block(*block, ray);
        const std::uint32_t lanes_hit = bits(found.hit & within<any_hit>(found.t, Real(hit.t)));
        if (lanes_hit == 0) continue;
        if constexpr (any_hit) return true;
        if (take_nearest(lanes_hit, found.t, block->id, first_id, hit) >= 0) hit.u = hit.v = 0;
    }
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
