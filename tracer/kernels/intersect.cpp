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
#include "tracer/kernels/single_ray.h"

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
    float largest = 0;
    for (int a = 0; a < 3; ++a)
        largest = std::max({largest, std::fabs(scene.hierarchy.bounds.lower[a]),
                            std::fabs(scene.hierarchy.bounds.upper[a]), std::fabs(origin[a])});
    return largest * box_padding;
}

bool hierarchy_is_empty(const CompiledScene& scene) { return scene.triangle_count + scene.sphere_count == 0; }

template <bool any_hit>
bool traverse(const CompiledScene& scene, const SingleRay& ray, RayHit& hit) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree))
        return traverse_single<any_hit>(scene, *bvh, ray, hit);
    return traverse_single<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), ray, hit);
}

template <bool any_hit>
void traverse(const CompiledScene& scene, Beam& beam) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree)) return traverse_beam<any_hit>(scene, *bvh, beam);
    traverse_beam<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), beam);
}

// Tests one ray against the hierarchy only; `hit` already holds the nearest plane or a miss at t_max.
template <bool any_hit>
bool trace_single(const CompiledScene& scene, const Ray& ray, RayHit& hit) {
    return traverse<any_hit>(scene, make_single_ray(ray, box_padding_of(scene, ray.origin)), hit);
}

Ray ray_of(const BeamRays& rays, int i) {
    return {{rays.origin[0], rays.origin[1], rays.origin[2]},
            {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]},
            rays.t_min[i],
            rays.t_max[i]};
}

// Rays one by one: t_max of `rays` is the distance of what is known already.
template <bool any_hit>
std::uint64_t trace_one_by_one(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, BeamHits* hits) {
    std::uint64_t found = 0;
    for (; active != 0; active &= active - 1) {
        const int i = std::countr_zero(active);
        RayHit hit = {rays.t_max[i], 0, 0, any_hit ? -1 : hits->id[i]};
        if (trace_single<any_hit>(scene, ray_of(rays, i), hit)) found |= std::uint64_t{1} << i;
        if constexpr (!any_hit) hits->t[i] = hit.t, hits->u[i] = hit.u, hits->v[i] = hit.v, hits->id[i] = hit.id;
    }
    return found;
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

}  // namespace

RayHit intersect_ray(const CompiledScene& scene, const Ray& ray) {
    RayHit hit = {ray.t_max, 0, 0, -1};
    if (scene.plane_count > 0) {
        Real t = Real(ray.t_max);
        Int id = Int(-1);
        nearest_planes(scene, ray.origin, splat3(ray.direction), Real(ray.t_min), t, id);
        hit.t = lane(t, 0), hit.id = lane(id, 0);
    }
    if (!hierarchy_is_empty(scene)) trace_single<false>(scene, ray, hit);
    return hit;
}

bool occluded_ray(const CompiledScene& scene, const Ray& ray) {
    RayHit hit = {ray.t_max, 0, 0, -1};
    if (scene.plane_count > 0) {
        Real t = Real(ray.t_max);
        Int id = Int(-1);
        nearest_planes(scene, ray.origin, splat3(ray.direction), Real(ray.t_min), t, id);
        if (lane(id, 0) >= 0) return true;
    }
    return !hierarchy_is_empty(scene) && trace_single<true>(scene, ray, hit);
}

void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, BeamHits& hits) {
    BeamRays shortened = rays;  // t_max: the nearest plane
    for (int at = 0; at < beam_rays; at += lanes) {
        const Vec3 direction = {load(rays.direction[0] + at), load(rays.direction[1] + at),
                                load(rays.direction[2] + at)};
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, rays.origin, direction, load(rays.t_min + at), t, id);
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
            nearest_planes(scene, rays.origin, direction, load(rays.t_min + at), t, id);
            blocked |= static_cast<std::uint64_t>(bits(id > Int(-1))) << at;
        }
        blocked &= active;
    }
    if (hierarchy_is_empty(scene)) return blocked;
    return blocked | trace_beams<true>(scene, rays, active & ~blocked, 0, nullptr);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
