// A beam: up to 64 rays of one origin that go roughly one way, tested together. Divided by its component along the
// beam's major axis k a direction becomes (U, V, 1), so that a point of the ray at depth z (along k) is (U z, V z, z)
// and everything about a shape that matters is linear in (U, V).
// Included once per target by Highway's foreach_target.h, hence the guard that toggles.

#if defined(RAYWALK_KERNELS_BEAM_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYWALK_KERNELS_BEAM_H
#undef RAYWALK_KERNELS_BEAM_H
#else
#define RAYWALK_KERNELS_BEAM_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/ground/vectors.h"
#include "tracer/kernels/ray_arrays.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

inline constexpr int beam_groups = beam_rays / lanes;
inline constexpr float infinity = std::numeric_limits<float>::infinity();

HWY_INLINE std::uint32_t group_bits(std::uint64_t active, int group) {
    return static_cast<std::uint32_t>(active >> (group * lanes)) & 0xffffu;
}

// Sixteen rays of a beam (a 4x4 block of pixels): slopes, nearest hit so far as 1 / depth (greater is nearer), and the
// slopes' ranges over the rays that are active.
struct alignas(64) BeamGroup {
    Real u, v;
    Real along;          // length of the direction along k: depth = t * along
    Real inverse_depth;  // of the nearest hit; starts at 1 / (t_max * along); +inf in lanes that are not active
    Real depth_min;      // t_min * along
    Real weight[3];      // barycentric weights of the nearest hit, unnormalised
    Int id;              // -1 while nothing nearer than t_max is found
    float u0, u1, v0, v1;
    std::uint32_t active;  // lanes
};

struct Beam {
    BeamGroup group[beam_groups];
    int k, a, b;  // axes: depth, U, V
    float sign;   // of the rays along k
    float origin[3];
    float padding;               // of boxes, scene units
    float u0, u1, v0, v1;        // ranges of the slopes, a hair wider
    float steepest;              // largest slope, in magnitude
    float depth_min, depth_max;  // where a hit would still count
    std::uint64_t active;
    int tests_left;  // of a triangle against a group; below zero the traversal gives up
};

// Fills everything of a beam but the ranges of slopes and depths: axis, sign and slopes, as its first active ray goes.
HWY_INLINE void project_beam(const BeamRays& rays, std::uint64_t active, Beam& beam) {
    const int first = std::countr_zero(active);
    const float d[3] = {rays.direction[0][first], rays.direction[1][first], rays.direction[2][first]};
    const float m[3] = {std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])};
    beam.k = m[0] >= m[1] ? (m[0] >= m[2] ? 0 : 2) : (m[1] >= m[2] ? 1 : 2);
    beam.a = (beam.k + 1) % 3;
    beam.b = (beam.k + 2) % 3;
    beam.sign = d[beam.k] < 0 ? -1.0f : 1.0f;
    for (int g = 0; g < beam_groups; ++g) {
        BeamGroup& group = beam.group[g];
        group.along = load(rays.direction[beam.k] + g * lanes) * Real(beam.sign);
        const Real scale = Real(1.0f) / group.along;
        group.u = load(rays.direction[beam.a] + g * lanes) * scale;
        group.v = load(rays.direction[beam.b] + g * lanes) * scale;
    }
}

// Of the active rays, those whose component along k is more than `share` of their length.
HWY_INLINE std::uint64_t rays_along(const BeamRays& rays, const Beam& beam, std::uint64_t active, float share) {
    std::uint64_t result = 0;
    for (int g = 0; g < beam_groups; ++g) {
        const Real u = load(rays.direction[beam.a] + g * lanes), v = load(rays.direction[beam.b] + g * lanes);
        const Real w = beam.group[g].along;
        const Real squared_length = mul_add(u, u, mul_add(v, v, w * w));
        const Mask good = (w > Real(0.0f)) & (w * w >= squared_length * Real(share * share));
        result |= static_cast<std::uint64_t>(bits(good)) << (g * lanes);
    }
    return result & active;
}

// Ranges of the slopes over the active rays, group by group and in all; group.active, beam.active.
HWY_INLINE void measure_beam(std::uint64_t active, Beam& beam) {
    beam.active = active;
    beam.u0 = beam.v0 = infinity;
    beam.u1 = beam.v1 = -infinity;
    for (int g = 0; g < beam_groups; ++g) {
        BeamGroup& group = beam.group[g];
        group.active = group_bits(active, g);
        if (group.active == 0) continue;
        const Mask live = mask_of_bits(group.active);
        group.u0 = reduce_min(select(live, group.u, Real(infinity)));
        group.u1 = reduce_max(select(live, group.u, Real(-infinity)));
        group.v0 = reduce_min(select(live, group.v, Real(infinity)));
        group.v1 = reduce_max(select(live, group.v, Real(-infinity)));
        beam.u0 = std::min(beam.u0, group.u0);
        beam.u1 = std::max(beam.u1, group.u1);
        beam.v0 = std::min(beam.v0, group.v0);
        beam.v1 = std::max(beam.v1, group.v1);
    }
}

// The active rays with the smaller slope along the beam's wider side.
HWY_INLINE std::uint64_t lower_half(const Beam& beam) {
    const bool by_u = beam.u1 - beam.u0 >= beam.v1 - beam.v0;
    const float middle = by_u ? 0.5f * (beam.u0 + beam.u1) : 0.5f * (beam.v0 + beam.v1);
    std::uint64_t lower = 0;
    for (int g = 0; g < beam_groups; ++g) {
        const Real slope = by_u ? beam.group[g].u : beam.group[g].v;
        lower |= static_cast<std::uint64_t>(bits(slope < Real(middle))) << (g * lanes);
    }
    return lower & beam.active;
}

// 1 / depth of the farthest of the active rays' nearest hits gives the depth beyond which nothing matters.
HWY_INLINE void shorten_beam(Beam& beam) {
    Real least = beam.group[0].inverse_depth;
    for (int g = 1; g < beam_groups; ++g) least = min(least, beam.group[g].inverse_depth);
    beam.depth_max = (1.0f + slab_slack) / reduce_min(least);
}

// The slopes' ranges a hair wider, for the roundings of what is computed with them.
HWY_INLINE void widen_beam(Beam& beam) {
    const float margin = 1e-6f;
    beam.u0 -= margin * std::fabs(beam.u0);
    beam.u1 += margin * std::fabs(beam.u1);
    beam.v0 -= margin * std::fabs(beam.v0);
    beam.v1 += margin * std::fabs(beam.v1);
}

// Ready for traversal: nearest hits and limits from the rays' t_min and t_max, ranges widened.
HWY_INLINE void start_beam(const BeamRays& rays, float padding, Beam& beam) {
    beam.padding = padding;
    for (int i = 0; i < 3; ++i) beam.origin[i] = rays.origin[i];
    Real depth_min = Real(infinity);
    for (int g = 0; g < beam_groups; ++g) {
        BeamGroup& group = beam.group[g];
        const Mask live = mask_of_bits(group_bits(beam.active, g));
        const Real inverse = Real(1.0f) / (load(rays.t_max + g * lanes) * group.along);
        group.inverse_depth = select(live, inverse, Real(infinity));
        group.depth_min = load(rays.t_min + g * lanes) * group.along;
        group.id = Int(-1);
        group.weight[0] = Real(1.0f);
        group.weight[1] = group.weight[2] = Real(0.0f);
        depth_min = min(depth_min, select(live, group.depth_min, Real(infinity)));
    }
    beam.depth_min = reduce_min(depth_min) * (1.0f - slab_slack);
    shorten_beam(beam);
    beam.steepest =
        std::max(std::max(std::fabs(beam.u0), std::fabs(beam.u1)), std::max(std::fabs(beam.v0), std::fabs(beam.v1)));
    widen_beam(beam);
}

// The rays of `part` alone, with what they have hit so far. Axis, sign and steepest slope stay, so that a ray hits the
// same, to the last bit, in whatever part of the beam it is traced.
HWY_INLINE Beam part_of(const Beam& beam, std::uint64_t part) {
    Beam result = beam;
    for (int g = 0; g < beam_groups; ++g)
        result.group[g].inverse_depth =
            select(mask_of_bits(group_bits(part, g)), beam.group[g].inverse_depth, Real(infinity));
    measure_beam(part, result);
    widen_beam(result);
    shorten_beam(result);
    return result;
}

// Takes over what the rays of `part` have hit in `traced`, which was a part of the beam.
HWY_INLINE void take_part(const Beam& traced, std::uint64_t part, Beam& beam) {
    beam.active = (beam.active & ~part) | (traced.active & part);
    for (int g = 0; g < beam_groups; ++g) {
        const BeamGroup& from = traced.group[g];
        BeamGroup& to = beam.group[g];
        const Mask taken = mask_of_bits(group_bits(part, g));
        to.inverse_depth = select(taken, from.inverse_depth, to.inverse_depth);
        to.id = select(taken, from.id, to.id);
        for (int i = 0; i < 3; ++i) to.weight[i] = select(taken, from.weight[i], to.weight[i]);
        to.active = group_bits(beam.active, g);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#endif  // RAYWALK_KERNELS_BEAM_H
