// A beam: up to 64 rays of one origin that go roughly one way, traced together. Divided by its component along the
// beam's major axis k a direction becomes (U, V, 1), so that all rays lie between four planes: a shape outside one of
// them cannot be hit by any of its rays. Beams only ever cull; a ray's hit is computed as for a ray alone.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tracer/kernels/traversal/packet_lanes.h"
#include "tracer/kernels/traversal/ray_shapes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

// Ranges of the slopes of each group of sixteen rays (a 4x4 block of pixels), a hair wider: middle - half to middle +
// half.
struct GroupRanges {
    float middle[packet_groups], half[packet_groups];
    float stretch[packet_groups];  // 1 / cosine of the steepest slope, for spheres
};

struct Beam {
    Real u[packet_groups], v[packet_groups];  // slopes
    // Once the beam is ready for triangles or spheres, what the tests of either need; the last two as in RayStream.
    GroupRanges range_u, range_v;
    Real growth[packet_groups], inverse_squared_length[packet_groups];
    const BeamRays* rays;
    HitPacket* hits;                   // nearest so far, of active rays; null for any-hit beams
    int k, a, b;                       // axes: depth, U, V
    float sign;                        // of the rays along k
    float padding;                     // of boxes, scene units
    float u0, u1, v0, v1;              // ranges of the slopes, a hair wider
    float depth_min, depth_max;        // where a hit would still count, along k
    float group_depth[packet_groups];  // depth_max group by group
    std::uint64_t active;              // any-hit rays that hit are not active any more
    bool ready_for_triangles, ready_for_spheres;
    int tests_left;  // of a triangle against a group; below zero the traversal gives up
};

// Hits count up to here.
HWY_INLINE Real limit_of(const Beam& beam, int at) {
    return load((beam.hits != nullptr ? beam.hits->t : beam.rays->t_max) + at);
}

// Axis, sign and slopes, as the first active ray goes; returns the active rays that go along with it: forward, and no
// steeper than this. Lanes of others take its slopes, so that they widen no range.
inline constexpr float steepest_slope = 2.25f;
HWY_INLINE std::uint64_t project_beam(const BeamRays& rays, std::uint64_t active, Beam& beam) {
    const int first = std::countr_zero(active);
    const float d[3] = {rays.direction[0][first], rays.direction[1][first], rays.direction[2][first]};
    const float m[3] = {std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])};
    beam.k = m[0] >= m[1] ? (m[0] >= m[2] ? 0 : 2) : (m[1] >= m[2] ? 1 : 2);
    beam.a = (beam.k + 1) % 3;
    beam.b = (beam.k + 2) % 3;
    beam.sign = d[beam.k] < 0 ? -1.0f : 1.0f;
    beam.rays = &rays;
    const Real first_u(d[beam.a] / m[beam.k]), first_v(d[beam.b] / m[beam.k]);
    std::uint64_t along = 0;
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const Real scale = Real(1.0f) / (load(rays.direction[beam.k] + at) * Real(beam.sign));
        const Real u = load(rays.direction[beam.a] + at) * scale, v = load(rays.direction[beam.b] + at) * scale;
        const Mask goes_along =
            mask_of(active, g) & (scale > Real(0.0f)) & (max(abs(u), abs(v)) <= Real(steepest_slope));
        beam.u[g] = select(goes_along, u, first_u);
        beam.v[g] = select(goes_along, v, first_v);
        along |= rays_of(goes_along, g);
    }
    return along;
}

// The slopes' ranges over all groups.
HWY_INLINE void measure_beam(Beam& beam) {
    Real u0 = beam.u[0], u1 = u0, v0 = beam.v[0], v1 = v0;
    for (int g = 1; g < packet_groups; ++g) {
        u0 = min(u0, beam.u[g]), u1 = max(u1, beam.u[g]);
        v0 = min(v0, beam.v[g]), v1 = max(v1, beam.v[g]);
    }
    float least[4];
    reduce_min({u0, -u1, v0, -v1}, least);
    const auto wider = [](float low) { return low - 1e-6f * std::fabs(low); };
    beam.u0 = wider(least[0]), beam.u1 = -wider(least[1]);
    beam.v0 = wider(least[2]), beam.v1 = -wider(least[3]);
}

// The same group by group, once the beam has met something that may be theirs.
HWY_INLINE void measure_groups(const Real (&slopes)[packet_groups], GroupRanges& range) {
    float low[packet_groups], high[packet_groups];
    reduce_min(slopes, low);
    reduce_max(slopes, high);
    for (int g = 0; g < packet_groups; ++g) {
        range.middle[g] = 0.5f * (low[g] + high[g]);
        range.half[g] = 0.5f * (high[g] - low[g]) + 1e-6f * std::fabs(range.middle[g]);
    }
}
HWY_INLINE void measure_groups(Beam& beam) {
    measure_groups(beam.u, beam.range_u);
    measure_groups(beam.v, beam.range_v);
}

inline void prepare_for_triangles(Beam& beam) {
    if (!beam.ready_for_spheres) measure_groups(beam);
    for (int g = 0; g < packet_groups; ++g) beam.growth[g] = growth_of(load3(beam.rays->direction, g * lanes));
    beam.ready_for_triangles = true;
}

inline void prepare_for_spheres(Beam& beam) {
    if (!beam.ready_for_triangles) measure_groups(beam);
    for (GroupRanges* range : {&beam.range_u, &beam.range_v}) {
        for (int g = 0; g < packet_groups; ++g) {
            const float steepest = std::fabs(range->middle[g]) + range->half[g];
            range->stretch[g] = std::sqrt(1 + steepest * steepest);
        }
    }
    for (int g = 0; g < packet_groups; ++g) {
        const Vec3 direction = load3(beam.rays->direction, g * lanes);
        beam.inverse_squared_length[g] = Real(1.0f) / dot(direction, direction);
    }
    beam.ready_for_spheres = true;
}

// The rays with the smaller slope along the beam's wider side.
HWY_INLINE std::uint64_t lower_half(const Beam& beam) {
    const bool by_u = beam.u1 - beam.u0 >= beam.v1 - beam.v0;
    const Real middle(by_u ? 0.5f * (beam.u0 + beam.u1) : 0.5f * (beam.v0 + beam.v1));
    std::uint64_t lower = 0;
    for (int g = 0; g < packet_groups; ++g) lower |= rays_of((by_u ? beam.u[g] : beam.v[g]) < middle, g);
    return lower & beam.active;
}

// The depths beyond which nothing matters: of the farthest of the active rays' limits. A hit's distance is rounded more
// coarsely than a corner's depth, hence the slack.
inline constexpr float depth_slack = 1e-5f;
HWY_INLINE void shorten_beam(Beam& beam) {
    Real depth[packet_groups];
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const Real limit = limit_of(beam, at) * (load(beam.rays->direction[beam.k] + at) * Real(beam.sign));
        depth[g] = select(mask_of(beam.active, g), limit * Real(1.0f + depth_slack), Real(0.0f));
    }
    reduce_max(depth, beam.group_depth);
    beam.depth_max = *std::max_element(beam.group_depth, beam.group_depth + packet_groups);
}

// Ready for traversal, its ranges measured.
HWY_INLINE void start_beam(float padding, HitPacket* hits, Beam& beam) {
    beam.padding = padding;
    beam.hits = hits;
    beam.ready_for_triangles = beam.ready_for_spheres = false;
    Real depth_min(infinity);
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const Real depth = load(beam.rays->t_min + at) * (load(beam.rays->direction[beam.k] + at) * Real(beam.sign));
        depth_min = select(mask_of(beam.active, g), min(depth, depth_min), depth_min);
    }
    beam.depth_min = reduce_min(depth_min) * (1.0f - slab_slack);
    shorten_beam(beam);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
