// A beam against a block of sixteen triangles or spheres: the block is culled in lanes of shapes, what is left is
// tested in lanes of rays.
#pragma once

#include "tracer/kernels/traversal/beam.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// A pair of a group of rays and a shape of a block that may meet: bit 16 group + lane of the shape.
using Pairs = std::uint64_t;

// What a group of rays hits, where that is nearer than what they have, or as near with a lower id; any-hit rays are
// active no more. Returns whether a nearest hit changed.
template <bool any_hit>
HWY_INLINE bool take_hits(Mask hit, Real t, Real u, Real v, std::int32_t id, int group, Beam& beam) {
    const int at = group * lanes;
    if constexpr (any_hit) {
        // Lanes that are not active stay so: nothing here waits for the mask that the last pair left.
        hit &= t < load(beam.rays->t_max + at);
        beam.active &= ~rays_of(hit, group);
        return false;
    } else {
        HitPacket& hits = *beam.hits;
        hit &= mask_of(beam.active, group);
        const Real nearest = load(hits.t + at);
        const Int own(id), nearest_id = load(hits.id + at);
        hit &= (t < nearest) | ((t == nearest) & (own < nearest_id));
        store(select(hit, t, nearest), hits.t + at);
        store(select(hit, own, nearest_id), hits.id + at);
        store_some(hit, u, hits.u + at);
        store_some(hit, v, hits.v + at);
        return any(hit);
    }
}

// Which triangles may touch the beam at all: outside none of its four sides and depths. Corners: along U, V and depth.
HWY_INLINE Mask touches_beam(const Beam& beam, const Vec3 (&p)[3], Real nearest) {
    Mask keep = nearest <= Real(beam.depth_max);
    const auto spans = [&](Real x0, Real x1, Real x2, float low, float high) HWY_ATTR {
        const Real below = min(min(neg_mul_add(Real(high), p[0].z, x0), neg_mul_add(Real(high), p[1].z, x1)),
                               neg_mul_add(Real(high), p[2].z, x2));
        const Real above = max(max(neg_mul_add(Real(low), p[0].z, x0), neg_mul_add(Real(low), p[1].z, x1)),
                               neg_mul_add(Real(low), p[2].z, x2));
        return (below <= Real(2 * beam.padding)) & (above >= Real(-2 * beam.padding));
    };
    keep &= spans(p[0].x, p[1].x, p[2].x, beam.u0, beam.u1);
    keep &= spans(p[0].y, p[1].y, p[2].y, beam.v0, beam.v1);
    return keep;
}

// The forms of sixteen triangles: [axis][lane].
struct alignas(64) BeamTriangles {
    float normal[3][lanes], u[3][lanes], v[3][lanes];
    float volume[lanes], spread[lanes];
    [[nodiscard]] HWY_INLINE TriangleForms one(int l) const {
        const auto vector = [l](const float(&a)[3][lanes]) HWY_ATTR {
            return Vec3{Real(a[0][l]), Real(a[1][l]), Real(a[2][l])};
        };
        return {vector(normal), vector(u), vector(v), Real(volume[l]), Real(spread[l])};
    }
};

// The three weights of a triangle are linear in (U, V) but for a common factor: a triangle touches a group of rays
// unless one of them is negative over the group's whole range, or the triangle lies behind all that the group hit.
struct TriangleEdges {
    Vec3 edge[3];
    Real steepness_u[3], steepness_v[3];  // magnitudes of edge.x and edge.y
};
HWY_INLINE TriangleEdges triangle_edges(const BeamTriangles& triangles, const Beam& beam) {
    const Real flip = copy_sign(Real(1.0f), load(triangles.volume)), flip_k = flip * Real(beam.sign);
    const auto turned = [&](const float(&form)[3][lanes]) HWY_ATTR {
        return Vec3{load(form[beam.a]) * flip, load(form[beam.b]) * flip, load(form[beam.k]) * flip_k};
    };
    TriangleEdges e;
    e.edge[1] = turned(triangles.u);
    e.edge[2] = turned(triangles.v);
    e.edge[0] = turned(triangles.normal) - e.edge[1] - e.edge[2];
    // Room for the triangles' growth and for all rounding.
    const Real margin = load(triangles.spread) * Real(triangle_growth * 8 * (1 + 2 * steepest_slope));
    for (int i = 0; i < 3; ++i) {
        e.edge[i].z += margin;
        e.steepness_u[i] = abs(e.edge[i].x);
        e.steepness_v[i] = abs(e.edge[i].y);
    }
    return e;
}
HWY_INLINE Mask touches_group(const Beam& beam, int g, Real nearest, const TriangleEdges& e) {
    const Real middle_u(beam.range_u.middle[g]), middle_v(beam.range_v.middle[g]);
    const Real half_u(beam.range_u.half[g]), half_v(beam.range_v.half[g]);
    Real least(infinity);
    for (int i = 0; i < 3; ++i) {
        const Real middle = mul_add(e.edge[i].x, middle_u, mul_add(e.edge[i].y, middle_v, e.edge[i].z));
        const Real most = mul_add(e.steepness_u[i], half_u, mul_add(e.steepness_v[i], half_v, middle));
        least = min(most, least);
    }
    return (least >= Real(0.0f)) & (nearest <= Real(beam.group_depth[g]));
}

template <bool any_hit>
HWY_INLINE void beam_triangles(const TriangleBlock& block, const float* origin, Beam& beam) {
    Vec3 p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = {load(block.corner[i][beam.a]) - Real(origin[beam.a]),
                load(block.corner[i][beam.b]) - Real(origin[beam.b]),
                (load(block.corner[i][beam.k]) - Real(origin[beam.k])) * Real(beam.sign)};
    const Real nearest = min(min(p[0].z, p[1].z), p[2].z);
    const std::uint32_t kept = bits(touches_beam(beam, p, nearest));
    if (kept == 0) return;
    if (!beam.ready_for_triangles) prepare_for_triangles(beam);

    const TriangleForms forms = triangle_forms(block, splat3(origin));
    BeamTriangles triangles;
    store3(forms.normal, triangles.normal, 0);
    store3(forms.u, triangles.u, 0);
    store3(forms.v, triangles.v, 0);
    store(forms.volume, triangles.volume);
    store(forms.spread, triangles.spread);
    const TriangleEdges edges = triangle_edges(triangles, beam);
    Pairs pairs = 0;
    for (int g = 0; g < packet_groups; ++g) pairs |= rays_of(kept & bits(touches_group(beam, g, nearest, edges)), g);

    beam.tests_left -= std::popcount(pairs);
    bool met = false;
    const std::uint64_t active = beam.active;
    for (; pairs != 0; pairs &= pairs - 1) {
        const int pair = std::countr_zero(pairs), group = pair / lanes, l = pair % lanes, at = group * lanes;
        const TriangleLanes r = meet_triangles(triangles.one(l), load3(beam.rays->direction, at), beam.growth[group],
                                               load(beam.rays->t_min + at));
        met |= take_hits<any_hit>(r.hit, r.t, r.u, r.v, block.id[l], group, beam);
    }
    if (met || beam.active != active) shorten_beam(beam);
}

// A sphere touches a group of rays unless it lies wholly beyond one of the planes through the group's steepest slopes,
// or behind all that the group hit.
HWY_INLINE Mask touches_group(const Beam& beam, int g, Real nearest, Vec3 center, Real radius) {
    const auto within = [&](Real x, const GroupRanges& range) HWY_ATTR {
        const Real beyond = abs(neg_mul_add(Real(range.middle[g]), center.z, x)) - Real(range.half[g]) * abs(center.z);
        return beyond <= radius * Real(range.stretch[g]);
    };
    return within(center.x, beam.range_u) & within(center.y, beam.range_v) & (nearest <= Real(beam.group_depth[g]));
}

template <bool any_hit>
HWY_INLINE void beam_spheres(const SphereBlock& block, const float* origin, std::int32_t first_id, Beam& beam) {
    const Vec3 center = sphere_centers(block, splat3(origin));
    alignas(64) float centers[3][lanes];
    store3(center, centers, 0);
    const Real grown = load(block.radius) + Real(beam.padding);
    const Vec3 turned = {load(centers[beam.a]), load(centers[beam.b]), load(centers[beam.k]) * Real(beam.sign)};
    const Real nearest = turned.z - grown;
    const std::uint32_t deep_enough =
        bits((turned.z + grown >= Real(beam.depth_min)) & (nearest <= Real(beam.depth_max)));
    if (deep_enough == 0) return;
    if (!beam.ready_for_spheres) prepare_for_spheres(beam);
    Pairs pairs = 0;
    for (int g = 0; g < packet_groups; ++g)
        pairs |= rays_of(deep_enough & bits(touches_group(beam, g, nearest, turned, grown)), g);

    bool met = false;
    const std::uint64_t active = beam.active;
    for (; pairs != 0; pairs &= pairs - 1) {
        const int pair = std::countr_zero(pairs), group = pair / lanes, l = pair % lanes, at = group * lanes;
        const Vec3 own = {Real(centers[0][l]), Real(centers[1][l]), Real(centers[2][l])};
        const SphereLanes r = meet_spheres(own, Real(block.radius[l]), load3(beam.rays->direction, at),
                                           beam.inverse_squared_length[group], load(beam.rays->t_min + at));
        met |= take_hits<any_hit>(r.hit, r.t, Real(0.0f), Real(0.0f), first_id + block.id[l], group, beam);
    }
    if (met || beam.active != active) shorten_beam(beam);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
