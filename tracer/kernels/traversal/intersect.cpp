// The doors of traversal: planes first, then the hierarchy; beams split until they are narrow.
#include "tracer/kernels/traversal/intersect.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tracer/kernels/traversal/beam_traversal.h"
#include "tracer/kernels/traversal/planes.h"
#include "tracer/kernels/traversal/stream_traversal.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// A beam wider than this in U or V is bisected (wide beams arise at silhouettes, for shadow rays).
constexpr float widest_beam = 0.08f;
// Fewer rays than this, or a beam split this often, go as a stream.
constexpr int fewest_rays = 4;
constexpr int most_splits = 12;
// Where triangles are smaller than the gaps between rays, a beam tests many that none of its rays hits: after this many
// tests a ray they go on as a stream.
constexpr int most_tests_per_ray = 12;

float box_padding_of(const CompiledScene& scene, const float* origin) {
    return box_padding *
           std::max({scene_reach(scene), std::fabs(origin[0]), std::fabs(origin[1]), std::fabs(origin[2])});
}

bool hierarchy_is_empty(const CompiledScene& scene) { return scene.triangle_count + scene.sphere_count == 0; }

template <bool any_hit>
std::uint64_t traverse(const CompiledScene& scene, std::uint64_t active, const RayStream& rays, HitPacket& hits) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree))
        return traverse_stream<any_hit>(scene, *bvh, active, rays, hits);
    return traverse_stream<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), active, rays, hits);
}

template <bool any_hit>
void traverse(const CompiledScene& scene, Beam& beam) {
    if (const Bvh* bvh = std::get_if<Bvh>(&scene.hierarchy.tree)) return traverse_beam<any_hit>(scene, *bvh, beam);
    traverse_beam<any_hit>(scene, *std::get_if<KdTree>(&scene.hierarchy.tree), beam);
}

// Rays of a beam as a stream; `hits` holds what is known already.
template <bool any_hit>
std::uint64_t trace_stream(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, HitPacket* hits) {
    RayStream stream;
    HitPacket limits;
    const float reach = scene_reach(scene);
    for (int g = 0; g < packet_groups; ++g) {
        if (lanes_of(active, g) == 0) continue;
        const int at = g * lanes;
        prepare_rays(splat3(rays.origin), load3(rays.direction, at), load(rays.t_min + at), reach, g, stream);
        if constexpr (any_hit) store(load(rays.t_max + at), limits.t + at);
    }
    return traverse<any_hit>(scene, active, stream, any_hit ? limits : *hits);
}

// Splits the active rays into beams that are narrow and well aligned with an axis, and traces each. `hits` holds what
// is known already, t_max at least; any-hit rays have none. Returns the any-hit rays that met something.
template <bool any_hit>
std::uint64_t trace_beams(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, int splits,
                          HitPacket* hits) {
    if (active == 0) return 0;
    if (std::popcount(active) < fewest_rays || splits > most_splits)
        return trace_stream<any_hit>(scene, rays, active, hits);
    Beam beam;
    const std::uint64_t along = project_beam(rays, active, beam);
    if (along != active)
        return trace_beams<any_hit>(scene, rays, along, splits + 1, hits) |
               trace_beams<any_hit>(scene, rays, active & ~along, splits + 1, hits);
    beam.active = active;
    measure_beam(beam);
    if (std::max(beam.u1 - beam.u0, beam.v1 - beam.v0) > widest_beam) {
        const std::uint64_t lower = lower_half(beam);
        return trace_beams<any_hit>(scene, rays, lower, splits + 1, hits) |
               trace_beams<any_hit>(scene, rays, active & ~lower, splits + 1, hits);
    }
    start_beam(box_padding_of(scene, rays.origin), hits, beam);
    beam.tests_left = most_tests_per_ray * std::popcount(active);
    traverse<any_hit>(scene, beam);
    const std::uint64_t met = any_hit ? active & ~beam.active : 0;
    return beam.tests_left < 0 ? met | trace_stream<any_hit>(scene, rays, beam.active, hits) : met;
}

// Planes have no barycentric weights.
HWY_INLINE void store_plane_hits(Real t, Int id, int at, HitPacket& hits) {
    store(t, hits.t + at);
    store(Real(0.0f), hits.u + at);
    store(Real(0.0f), hits.v + at);
    store(id, hits.id + at);
}

// Makes the rays ready; `hits` becomes the nearest planes, or misses at t_max. Returns the rays that meet a plane.
std::uint64_t prepare_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active, RayStream& stream,
                             HitPacket& hits) {
    const float reach = scene_reach(scene);
    std::uint64_t met = 0;
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const std::uint32_t own = lanes_of(active, g);
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        if (own != 0) {
            const Vec3 origin = load3(rays.origin, at), direction = load3(rays.direction, at);
            const Real t_min = load(rays.t_min + at);
            prepare_rays(origin, direction, t_min, reach, g, stream);
            nearest_planes(scene, origin, direction, t_min, t, id);
            id = select(mask_of_bits(own), id, Int(-1));
            met |= rays_of(id > Int(-1), g);
        }
        store_plane_hits(t, id, at, hits);
    }
    return met;
}

}  // namespace

void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, HitPacket& hits) {
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        if (scene.plane_count > 0) {
            nearest_planes(scene, splat3(rays.origin), load3(rays.direction, at), load(rays.t_min + at), t, id);
            id = select(mask_of(active, g), id, Int(-1));
        }
        store_plane_hits(t, id, at, hits);
    }
    if (!hierarchy_is_empty(scene)) trace_beams<false>(scene, rays, active, 0, &hits);
}

std::uint64_t occluded_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, bool together) {
    std::uint64_t blocked = 0;
    if (scene.plane_count > 0) {
        for (int g = 0; g < packet_groups; ++g) {
            const int at = g * lanes;
            Real t = load(rays.t_max + at);
            Int id = Int(-1);
            nearest_planes(scene, splat3(rays.origin), load3(rays.direction, at), load(rays.t_min + at), t, id);
            blocked |= rays_of(id > Int(-1), g);
        }
        blocked &= active;
    }
    if (hierarchy_is_empty(scene)) return blocked;
    active &= ~blocked;
    return blocked | (together ? trace_beams<true>(scene, rays, active, 0, nullptr)
                               : trace_stream<true>(scene, rays, active, nullptr));
}

void intersect_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active, HitPacket& hits) {
    RayStream stream;
    prepare_packet(scene, rays, active, stream, hits);
    if (!hierarchy_is_empty(scene)) traverse<false>(scene, active, stream, hits);
}

std::uint64_t occluded_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active) {
    RayStream stream;
    HitPacket hits;
    const std::uint64_t blocked = prepare_packet(scene, rays, active, stream, hits);
    if (hierarchy_is_empty(scene)) return blocked;
    return blocked | traverse<true>(scene, active & ~blocked, stream, hits);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
