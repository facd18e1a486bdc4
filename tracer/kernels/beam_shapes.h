// A beam against a block of sixteen triangles or spheres: the block is culled in lanes of shapes, what is left is
// tested in lanes of rays.
// Included once per target by Highway's foreach_target.h, hence the guard that toggles.

#if defined(RAYWALK_KERNELS_BEAM_SHAPES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYWALK_KERNELS_BEAM_SHAPES_H
#undef RAYWALK_KERNELS_BEAM_SHAPES_H
#else
#define RAYWALK_KERNELS_BEAM_SHAPES_H
#endif

#include "tracer/kernels/beam.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Nearer than what the group has, or as near with a lower id: then it is the group's. Any-hit rays that hit are done:
// nothing is nearer than an infinite inverse depth.
template <bool any_hit>
HWY_INLINE Mask nearer(const BeamGroup& group, Real inverse_depth, Int id) {
    const Mask closer = inverse_depth > group.inverse_depth;
    if constexpr (any_hit) return closer;
    return closer | ((inverse_depth == group.inverse_depth) & (id < group.id));
}

template <bool any_hit>
HWY_INLINE void finish_hits(std::uint64_t hit, Beam& beam) {
    if (hit == 0) return;
    if constexpr (any_hit) {
        beam.active &= ~hit;
        for (int g = 0; g < beam_groups; ++g) beam.group[g].active &= ~group_bits(hit, g);
    }
    if (!any_hit || beam.active != 0) shorten_beam(beam);
}

// Sixteen triangles relative to the beam's origin, turned to (U, V, depth) axes. The three edge functions are linear in
// (U, V): edge[i] . (U, V, 1) has the sign of the weight of corner i. They are formed from sums and differences of
// corners, (P1 + P2) x (P2 - P1), because P1 x P2 itself cancels: and so that the two triangles of an edge see exactly
// opposite values, and no ray slips between.
struct alignas(64) BeamTriangles {
    float edge[3][3][lanes];  // by corner, by axis
    float plane[3][lanes];    // 1 / depth = plane . (U, V, 1)
};

// Which triangles may touch the beam at all: outside none of its four sides and depths.
HWY_INLINE Mask touches_beam(const Beam& beam, const Vec3 (&p)[3]) {
    Mask keep = min(min(p[0].z, p[1].z), p[2].z) <= Real(beam.depth_max);
    const auto spans = [&](Real x0, Real x1, Real x2, float low, float high) HWY_ATTR {
        const Real below = min(min(neg_mul_add(Real(high), p[0].z, x0), neg_mul_add(Real(high), p[1].z, x1)),
                               neg_mul_add(Real(high), p[2].z, x2));
        const Real above = max(max(neg_mul_add(Real(low), p[0].z, x0), neg_mul_add(Real(low), p[1].z, x1)),
                               neg_mul_add(Real(low), p[2].z, x2));
        return (below <= Real(beam.padding)) & (above >= Real(-beam.padding));
    };
    keep &= spans(p[0].x, p[1].x, p[2].x, beam.u0, beam.u1);
    keep &= spans(p[0].y, p[1].y, p[2].y, beam.v0, beam.v1);
    return keep;
}

// No weight is negative over the whole (U, V) box of the group.
HWY_INLINE Mask touches_group(const BeamGroup& group, const Vec3 (&edge)[3]) {
    Mask keep = mask_of_bits(0xffffu);
    for (const Vec3& e : edge) {
        const Real from_u = max(e.x * Real(group.u0), e.x * Real(group.u1));
        const Real from_v = max(e.y * Real(group.v0), e.y * Real(group.v1));
        keep &= e.z + from_u + from_v >= Real(-sum_slack) * (abs(e.z) + abs(from_u) + abs(from_v));
    }
    return keep;
}

template <bool any_hit>
HWY_INLINE std::uint32_t hit_group(std::uint32_t candidates, const BeamTriangles& triangles, const std::int32_t* ids,
                                   BeamGroup& group) {
    const Real u = group.u, v = group.v;
    Mask any = mask_of_bits(0);
    for (; candidates != 0; candidates &= candidates - 1) {
        const int l = std::countr_zero(candidates);
        const auto linear = [&](const float(&c)[3][lanes]) HWY_ATTR {
            return mul_add(Real(c[0][l]), u, mul_add(Real(c[1][l]), v, Real(c[2][l])));
        };
        const Real w0 = linear(triangles.edge[0]), w1 = linear(triangles.edge[1]), w2 = linear(triangles.edge[2]);
        const Real inverse_depth = linear(triangles.plane);
        const Int id = Int(ids[l]);
        const Mask hit = (min(min(w0, w1), w2) >= Real(0.0f)) & nearer<any_hit>(group, inverse_depth, id) &
                         (inverse_depth * group.depth_min < Real(1.0f));
        if constexpr (any_hit) {
            group.inverse_depth = select(hit, Real(infinity), group.inverse_depth);
        } else {
            group.inverse_depth = select(hit, inverse_depth, group.inverse_depth);
            group.id = select(hit, id, group.id);
            group.weight[0] = select(hit, w0, group.weight[0]);
            group.weight[1] = select(hit, w1, group.weight[1]);
            group.weight[2] = select(hit, w2, group.weight[2]);
        }
        any |= hit;
    }
    return bits(any);
}

template <bool any_hit>
HWY_INLINE void beam_triangles(const TriangleBlock& block, Beam& beam) {
    const Real sign = Real(beam.sign);
    Vec3 p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = {load(block.corner[i][beam.a]) - Real(beam.origin[beam.a]),
                load(block.corner[i][beam.b]) - Real(beam.origin[beam.b]),
                (load(block.corner[i][beam.k]) - Real(beam.origin[beam.k])) * sign};
    const std::uint32_t kept = bits(touches_beam(beam, p));
    if (kept == 0) return;

    const Vec3 e0 = p[2] - p[1], e1 = p[0] - p[2], e2 = p[1] - p[0];
    const Vec3 normal = cross(e1, e2);
    const Real volume = dot(p[0], normal);
    const Real flip = copy_sign(Real(1.0f), volume), scale = Real(1.0f) / volume;
    Vec3 edge[3] = {cross(p[1] + p[2], e0) * flip, cross(p[2] + p[0], e1) * flip, cross(p[0] + p[1], e2) * flip};
    // Around a shared corner the rounded edges may leave a gap: each is moved outward by its own rounding.
    for (Vec3& e : edge) {
        const Real magnitude = abs(e.x) * Real(beam.steepest) + abs(e.y) * Real(beam.steepest) + abs(e.z);
        e.z = mul_add(Real(sum_slack), magnitude, e.z);
    }
    BeamTriangles triangles;
    for (int i = 0; i < 3; ++i) {
        store(edge[i].x, triangles.edge[i][0]);
        store(edge[i].y, triangles.edge[i][1]);
        store(edge[i].z, triangles.edge[i][2]);
    }
    store(normal.x * scale, triangles.plane[0]);
    store(normal.y * scale, triangles.plane[1]);
    store(normal.z * scale, triangles.plane[2]);

    std::uint64_t hit = 0;
    for (int g = 0; g < beam_groups; ++g) {
        BeamGroup& group = beam.group[g];
        if (group.active == 0) continue;
        const std::uint32_t candidates = kept & bits(touches_group(group, edge));
        if (candidates == 0) continue;
        beam.tests_left -= std::popcount(candidates);
        hit |= static_cast<std::uint64_t>(hit_group<any_hit>(candidates, triangles, block.id, group)) << (g * lanes);
    }
    finish_hits<any_hit>(hit, beam);
}

// Closest approach of the ray (U, V, 1) to the centre, as for single rays.
template <bool any_hit>
HWY_INLINE std::uint32_t hit_group_sphere(const float (&center)[3], float radius, std::int32_t id, BeamGroup& group) {
    const Vec3 d = {group.u, group.v, Real(1.0f)};
    const Real inverse_squared = Real(1.0f) / dot(d, d);
    const Vec3 c = splat3(center);
    const Real middle = dot(c, d) * inverse_squared;
    const Vec3 p = c - d * middle;
    const Real discriminant = Real(radius * radius) - dot(p, p);
    const Mask meets = discriminant >= Real(0.0f);
    if (none(meets)) return 0;
    const Real half = sqrt(max(discriminant, Real(0.0f)) * inverse_squared);
    const Real first = middle - half;
    const Real depth = select(first > group.depth_min, first, middle + half);
    const Real inverse_depth = Real(1.0f) / depth;
    const Mask hit = meets & (depth > group.depth_min) & nearer<any_hit>(group, inverse_depth, Int(id));
    if constexpr (any_hit) {
        group.inverse_depth = select(hit, Real(infinity), group.inverse_depth);
    } else {
        group.inverse_depth = select(hit, inverse_depth, group.inverse_depth);
        group.id = select(hit, Int(id), group.id);
        group.weight[0] = select(hit, Real(1.0f), group.weight[0]);
        group.weight[1] = select(hit, Real(0.0f), group.weight[1]);
        group.weight[2] = select(hit, Real(0.0f), group.weight[2]);
    }
    return bits(hit);
}

template <bool any_hit>
HWY_INLINE void beam_spheres(const SphereBlock& block, std::int32_t first_id, Beam& beam) {
    const Real x = load(block.center[beam.a]) - Real(beam.origin[beam.a]);
    const Real y = load(block.center[beam.b]) - Real(beam.origin[beam.b]);
    const Real z = (load(block.center[beam.k]) - Real(beam.origin[beam.k])) * Real(beam.sign);
    const Real radius = load(block.radius);
    // The sphere's box against the beam, as if it were a node's.
    const Real grown = radius + Real(beam.padding);
    const Real near_z = max(z - grown, Real(beam.depth_min)), far_z = z + grown;
    const auto reach = [&](float slope, Real at_rising, Real at_falling)
                           HWY_ATTR { return Real(slope) * (slope >= 0 ? at_rising : at_falling); };
    const Mask keep = (far_z >= Real(beam.depth_min)) & (near_z <= Real(beam.depth_max)) &
                      (x - grown <= reach(beam.u1, far_z, near_z)) & (x + grown >= reach(beam.u0, near_z, far_z)) &
                      (y - grown <= reach(beam.v1, far_z, near_z)) & (y + grown >= reach(beam.v0, near_z, far_z));
    std::uint32_t kept = bits(keep);
    if (kept == 0) return;
    alignas(64) float centers[3][lanes];
    store(x, centers[0]);
    store(y, centers[1]);
    store(z, centers[2]);
    std::uint64_t hit = 0;
    for (; kept != 0; kept &= kept - 1) {
        const int l = std::countr_zero(kept);
        const float center[3] = {centers[0][l], centers[1][l], centers[2][l]};
        for (int g = 0; g < beam_groups; ++g) {
            if (beam.group[g].active == 0) continue;
            hit |= static_cast<std::uint64_t>(
                       hit_group_sphere<any_hit>(center, block.radius[l], first_id + block.id[l], beam.group[g]))
                   << (g * lanes);
        }
    }
    finish_hits<any_hit>(hit, beam);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#endif  // RAYWALK_KERNELS_BEAM_SHAPES_H
