// The doors of traversal: planes first, then the hierarchy; beams split until they are narrow.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/kernels/intersect.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h:
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tracer/kernels/beam_traversal.h"
#include "tracer/kernels/intersect.h"
#include "tracer/kernels/planes.h"
#include "tracer/kernels/stream_traversal.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// A beam wider than this in U or V is bisected (wide beams arise at silhouettes, for shadow rays).
constexpr float widest_beam = 0.08f;
// Fewer rays than this, or a beam split this often, goes ray by ray.
constexpr int fewest_rays = 4;
constexpr int most_splits = 12;
// Where triangles are smaller than the gaps between rays, a beam tests many that none of its rays hits: after this many
// tests a ray it is split, down to this many rays.
constexpr int most_tests_per_ray = 12;
constexpr int rays_of_dense_beam = 8;
// Rays whose share along the major axis is below the first leave the beam; those above the second stay together.
constexpr float least_share = 0.1f, good_share = 0.3f;

float box_padding_of(const CompiledScene& scene, const float* origin) {
    return box_padding *
           std::max({scene_reach(scene), std::fabs(origin[0]), std::fabs(origin[1]), std::fabs(origin[2])});
}

bool hierarchy_is_empty(const CompiledScene& scene) { return scene.triangle_count + scene.sphere_count == 0; }

template <bool any_hit>
std::uint64_t traverse(const CompiledScene& scene, std::uint64_t active, const RayStream& rays, BeamHits& hits) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree))
        return traverse_stream<any_hit>(scene, *bvh, active, rays, hits);
    return traverse_stream<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), active, rays, hits);
}

template <bool any_hit>
void traverse(const CompiledScene& scene, Beam& beam) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree)) return traverse_beam<any_hit>(scene, *bvh, beam);
    traverse_beam<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), beam);
}

// Rays of a beam one by one: t_max of `rays` is the distance of what is known already.
template <bool any_hit>
std::uint64_t trace_one_by_one(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, BeamHits* hits) {
    RayStream stream;
    BeamHits limits;
    const float reach = scene_reach(scene);
    for (int g = 0; g < beam_groups; ++g) {
        if (group_bits(active, g) == 0) continue;
        const int at = g * lanes;
        const Vec3 direction = {load(rays.direction[0] + at), load(rays.direction[1] + at),
                                load(rays.direction[2] + at)};
        prepare_rays(splat3(rays.origin), direction, load(rays.t_min + at), reach, g, stream);
        if constexpr (any_hit) store(load(rays.t_max + at), limits.t + at);
    }
    return traverse<any_hit>(scene, active, stream, any_hit ? limits : *hits);
}

// Writes what the beam found over what was known.
void take_hits(const Beam& beam, BeamHits& hits) {
    for (int g = 0; g < beam_groups; ++g) {
        const BeamGroup& group = beam.group[g];
        if (group.active == 0) continue;
        const int at = g * lanes;
        const Mask found = mask_of_bits(group.active) & (group.id > Int(-1));
        const Real t = Real(1.0f) / (group.inverse_depth * group.along);
        const Real scale = Real(1.0f) / (group.weight[0] + group.weight[1] + group.weight[2]);
        store(select(found, t, load(hits.t + at)), hits.t + at);
        store(select(found, group.weight[1] * scale, load(hits.u + at)), hits.u + at);
        store(select(found, group.weight[2] * scale, load(hits.v + at)), hits.v + at);
        store(select(found, group.id, load(hits.id + at)), hits.id + at);
    }
}

// Traces a beam that is ready, in parts where too many shapes lie in its way.
template <bool any_hit>
void trace_beam(const CompiledScene& scene, bool dense, Beam& beam) {
    const int rays = std::popcount(beam.active);
    const bool small = rays <= rays_of_dense_beam;
    beam.tests_left = small ? std::numeric_limits<int>::max() : most_tests_per_ray * rays;
    if (small || !dense) traverse<any_hit>(scene, beam);
    if (small || (!dense && beam.tests_left >= 0)) return;
    if (any_hit && beam.active == 0) return;

    measure_beam(beam.active, beam);
    const std::uint64_t lower = lower_half(beam), upper = beam.active & ~lower;
    for (const std::uint64_t part : {lower, upper}) {
        if (part == 0) continue;
        Beam traced = part_of(beam, part);
        // Rays of one direction do not come apart by slope: they are one small beam, whatever their number.
        if (part == (lower | upper)) {
            traced.tests_left = std::numeric_limits<int>::max();
            traverse<any_hit>(scene, traced);
        } else {
            trace_beam<any_hit>(scene, true, traced);
        }
        take_part(traced, part, beam);
    }
}

// Splits the active rays into beams that are narrow and well aligned with an axis, and traces each. Returns which rays
// met something (any_hit only).
template <bool any_hit>
std::uint64_t trace_beams(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, int splits,
                          BeamHits* hits) {
    if (active == 0) return 0;
    if (std::popcount(active) < fewest_rays || splits > most_splits)
        return trace_one_by_one<any_hit>(scene, rays, active, hits);

    Beam beam;
    project_beam(rays, active, beam);
    if (rays_along(rays, beam, active, least_share) != active) {
        const std::uint64_t stay = rays_along(rays, beam, active, good_share);
        return trace_beams<any_hit>(scene, rays, stay, splits + 1, hits) |
               trace_beams<any_hit>(scene, rays, active & ~stay, splits + 1, hits);
    }
    measure_beam(active, beam);
    if (std::max(beam.u1 - beam.u0, beam.v1 - beam.v0) > widest_beam) {
        const std::uint64_t lower = lower_half(beam);
        return trace_beams<any_hit>(scene, rays, lower, splits + 1, hits) |
               trace_beams<any_hit>(scene, rays, active & ~lower, splits + 1, hits);
    }
    start_beam(rays, box_padding_of(scene, rays.origin), beam);
    trace_beam<any_hit>(scene, false, beam);
    if constexpr (any_hit) return active & ~beam.active;
    take_hits(beam, *hits);
    return 0;
}

// Makes the rays ready; `hits` becomes the nearest planes, or misses at t_max. Returns the rays that meet a plane.
std::uint64_t prepare_scattered(const CompiledScene& scene, const ScatteredRays& rays, std::uint64_t active,
                                RayStream& stream, BeamHits& hits) {
    const float reach = scene_reach(scene);
    std::uint64_t met = 0;
    for (int g = 0; g < beam_groups; ++g) {
        const int at = g * lanes;
        const std::uint32_t own = group_bits(active, g);
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        if (own != 0) {
            const Vec3 origin = {load(rays.origin[0] + at), load(rays.origin[1] + at), load(rays.origin[2] + at)};
            const Vec3 direction = {load(rays.direction[0] + at), load(rays.direction[1] + at),
                                    load(rays.direction[2] + at)};
            const Real t_min = load(rays.t_min + at);
            prepare_rays(origin, direction, t_min, reach, g, stream);
            nearest_planes(scene, origin, direction, t_min, t, id);
            id = select(mask_of_bits(own), id, Int(-1));
            met |= static_cast<std::uint64_t>(bits(id > Int(-1))) << at;
        }
        store(t, hits.t + at);
        store(Real(0.0f), hits.u + at);
        store(Real(0.0f), hits.v + at);
        store(id, hits.id + at);
    }
    return met;
}

}  // namespace

void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, BeamHits& hits) {
    BeamRays shortened = rays;  // t_max: the nearest plane
    for (int at = 0; at < beam_rays; at += lanes) {
        const Vec3 direction = {load(rays.direction[0] + at), load(rays.direction[1] + at),
                                load(rays.direction[2] + at)};
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, splat3(rays.origin), direction, load(rays.t_min + at), t, id);
        id = select(mask_of_bits(group_bits(active, at / lanes)), id, Int(-1));
        store(t, shortened.t_max + at);
        store(t, hits.t + at);
        store(Real(0.0f), hits.u + at);
        store(Real(0.0f), hits.v + at);
        store(id, hits.id + at);
    }
    if (!hierarchy_is_empty(scene)) trace_beams<false>(scene, shortened, active, 0, &hits);
}

std::uint64_t occluded_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active) {
    std::uint64_t blocked = 0;
    if (scene.plane_count > 0) {
        for (int at = 0; at < beam_rays; at += lanes) {
            const Vec3 direction = {load(rays.direction[0] + at), load(rays.direction[1] + at),
                                    load(rays.direction[2] + at)};
            Real t = load(rays.t_max + at);
            Int id = Int(-1);
            nearest_planes(scene, splat3(rays.origin), direction, load(rays.t_min + at), t, id);
            blocked |= static_cast<std::uint64_t>(bits(id > Int(-1))) << at;
        }
        blocked &= active;
    }
    if (hierarchy_is_empty(scene)) return blocked;
    return blocked | trace_beams<true>(scene, rays, active & ~blocked, 0, nullptr);
}

void intersect_scattered(const CompiledScene& scene, const ScatteredRays& rays, std::uint64_t active, BeamHits& hits) {
    RayStream stream;
    prepare_scattered(scene, rays, active, stream, hits);
    if (!hierarchy_is_empty(scene)) traverse<false>(scene, active, stream, hits);
}

std::uint64_t occluded_scattered(const CompiledScene& scene, const ScatteredRays& rays, std::uint64_t active) {
    RayStream stream;
    BeamHits hits;
    const std::uint64_t blocked = prepare_scattered(scene, rays, active, stream, hits);
    if (hierarchy_is_empty(scene)) return blocked;
    return blocked | traverse<true>(scene, active & ~blocked, stream, hits);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
