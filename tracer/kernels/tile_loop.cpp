// A tile of 8x8 pixels, traced level by level: camera rays, then all rays that they spawned, and so on. Radiance is a
// sum of weighted terms, so no recursion is needed; queues hold the rays of the next level.
#include "tracer/kernels/tile_loop.h"

#include <bit>
#include <cstdint>

#include "tracer/kernels/shading/camera_rays.h"
#include "tracer/kernels/shading/phong.h"
#include "tracer/kernels/shading/resolve.h"
#include "tracer/kernels/shading/surface.h"
#include "tracer/kernels/tile_scratch.h"
#include "tracer/kernels/traversal/intersect.h"
#include "tracer/kernels/traversal/mirror_beam.h"
#include "tracer/kernels/whitted/spawn.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// Sample `sample` of a tile: what every step of it needs.
struct SampleContext {
    const TileJob& job;
    const TileCamera& camera;
    std::uint32_t sample;
    TileScratch& scratch;
    RayCounts& counts;
};

// The camera rays of the tile, as queue entries 0 to 63 in pixel order; returns those inside the picture.
std::uint64_t make_camera_rays(const SampleContext& c) {
    RayQueue& queue = c.scratch.queues[0];
    BeamRays& beam = c.scratch.camera_beam;
    std::uint64_t active = 0;
    for (int g = 0; g < beam_rays / lanes; ++g) {
        const int at = g * lanes;
        const CameraRays rays = camera_rays(c.camera, g, c.sample, c.job.settings.seed);
        store(rays.origin.x, queue.origin[0] + at);
        store(rays.origin.y, queue.origin[1] + at);
        store(rays.origin.z, queue.origin[2] + at);
        store(rays.direction.x, queue.direction[0] + at);
        store(rays.direction.y, queue.direction[1] + at);
        store(rays.direction.z, queue.direction[2] + at);
        store3(rays.direction, beam.direction, at);
        store(Real(0.0f), beam.t_min + at);
        store(Real(farthest), beam.t_max + at);
        store(Real(0.0f), queue.length + at);
        store(Real(1.0f), queue.weight + at);
        store(Real(1.0f), queue.medium + at);
        active |= rays_of(bits(inside_picture(c.camera, g)), g);
    }
    for (int axis = 0; axis < 3; ++axis) beam.origin[axis] = c.camera.eye[axis];
    return active;
}

// Rays of the queue from `first` on that share no origin; scratch.hits of the others stays.
void intersect_queued(const CompiledScene& scene, const RayQueue& queue, int first, std::uint64_t active,
                      TileScratch& scratch) {
    if (active == 0) return;
    ScatteredRays& rays = scratch.scattered;
    for (int at = 0; at < beam_rays; at += lanes) {
        const int q = first + at;
        for (int axis = 0; axis < 3; ++axis) {
            store(load(queue.origin[axis] + q), rays.origin[axis] + at);
            store(load(queue.direction[axis] + q), rays.direction[axis] + at);
        }
        store(Real(0.0f), rays.t_min + at);
        store(Real(farthest), rays.t_max + at);
    }
    intersect_scattered(scene, rays, active, scratch.beam_hits);
    take_hits_of(active, scratch.beam_hits, scratch.hits);
}

HWY_INLINE HitLanes load_hits(const RayQueue& queue, int first, std::uint64_t active, const BeamHits& hits, int group) {
    const int at = group * lanes, q = first + at;
    HitLanes h;
    h.origin = {load(queue.origin[0] + q), load(queue.origin[1] + q), load(queue.origin[2] + q)};
    h.direction = {load(queue.direction[0] + q), load(queue.direction[1] + q), load(queue.direction[2] + q)};
    h.t = load(hits.t + at);
    h.u = load(hits.u + at);
    h.v = load(hits.v + at);
    h.id = load(hits.id + at);
    h.active = mask_of_bits(lanes_of(active, group)) & (h.id > Int(-1));
    return h;
}

// What lights need to know of a group's hits.
HWY_INLINE void store_for_lights(const HitLanes& hit, const SurfaceLanes& s, const MaterialLanes& m, Real length,
                                 int group, ShadeBatch& shade) {
    const int at = group * lanes;
    const Real zero(0.0f);
    store3(s.position, shade.position, at);
    store3(s.normal, shade.normal, at);
    store3(s.geometric_normal, shade.geometric_normal, at);
    store3(-hit.direction, shade.view, at);
    store3(m.color, shade.color, at);
    store(m.specular, shade.specular_weight + at);
    store(m.shininess, shade.shininess + at);
    store(length, shade.length + at);
    store(s.offset, shade.offset + at);
    const Mask lifted = hit.active & (max(abs(s.lift.x), max(abs(s.lift.y), abs(s.lift.z))) > zero);
    if (any(s.smooth)) store3(s.lift, shade.lift, at);
    shade.lifted |= rays_of(bits(lifted), group);
    const Mask colored = max(m.color.x, max(m.color.y, m.color.z)) > zero, shiny = m.specular > zero;
    store(select(colored, Real(1.0f), zero), shade.colored + at);
    shade.lit |= rays_of(bits(hit.active & (colored | shiny)), group);
    shade.all_fifth_powers &= none(and_not(m.shininess == Int(5), hit.active & shiny));
}

// Whether a group's hits reflect or transmit anything.
HWY_INLINE bool spawns(const HitLanes& hit, const MaterialLanes& m) {
    return any(hit.active & (max(m.reflection, m.transmission) > Real(0.0f)));
}

// Queues the mirrored and refracted rays of a group's hits. Not inlined: its registers would be spilled in every loop
// over hits, where few reflect (cornell_box 1.2 to 1.3 times as fast without).
HWY_NOINLINE void spawn(const HitLanes& hit, const SurfaceLanes& s, const MaterialLanes& m, const Real& length,
                        const Real& weight, const Real& medium, const Int& pixel, RayQueue& next, RayCounts& counts) {
    const Real zero(0.0f);
    const Mask reflecting = hit.active & (m.reflection > zero), transmitting = hit.active & (m.transmission > zero);
    if (any(reflecting)) {
        SpawnedRays rays;
        rays.active = reflecting;
        rays.direction = mirrored(hit.direction, s.normal);
        rays.weight = weight * m.reflection;
        rays.medium = medium;
        rays.mirror = select(s.sphere | s.smooth, Int(-1), hit.id);
        enqueue(rays, s, length, pixel, next);
        counts.reflection += static_cast<std::uint64_t>(std::popcount(bits(reflecting)));
    }
    if (any(transmitting)) {
        Mask total;
        enqueue(refracted(hit, s, transmitting, weight * m.transmission, medium, total), s, length, pixel, next);
        const auto reflected = static_cast<std::uint64_t>(std::popcount(bits(total)));
        counts.reflection += reflected;
        counts.refraction += static_cast<std::uint64_t>(std::popcount(bits(transmitting))) - reflected;
    }
}

// Adds the radiance of a group's hits to their pixels.
HWY_INLINE void add_radiance(const ShadeBatch& shade, std::uint32_t hit, int group, const std::int32_t* pixel,
                             float (*radiance)[beam_rays]) {
    const int at = group * lanes;
    const Real weight = load(shade.weight + at), base = load(shade.base + at);
    Vec3 value = load3(shade.local, at);
    value = {weight * (base + value.x), weight * (base + value.y), weight * (base + value.z)};
    if (pixel == nullptr) {  // camera rays: ray and pixel are the same
        const Mask shaded = mask_of_bits(hit);
        const Real zero(0.0f);
        store3(select(shaded, value, Vec3{zero, zero, zero}), radiance, at);
        return;
    }
    HWY_ALIGN float values[3][lanes];
    store(value.x, values[0]);
    store(value.y, values[1]);
    store(value.z, values[2]);
    for (; hit != 0; hit &= hit - 1) {
        const int i = std::countr_zero(hit);
        for (int channel = 0; channel < 3; ++channel) radiance[channel][pixel[at + i]] += values[channel][i];
    }
}

// Shades what the rays of the queue from `first` on hit, and queues the rays of the next level.
void shade_hits(const SampleContext& c, int depth, int first, std::uint64_t active) {
    const CompiledScene& scene = *c.job.scene;
    const RayQueue& queue = c.scratch.queues[depth & 1];
    RayQueue& next = c.scratch.queues[(depth + 1) & 1];
    ShadeBatch& shade = c.scratch.shade;
    shade.lit = shade.lifted = 0;
    shade.all_fifth_powers = true;
    std::uint32_t hit_lanes[beam_rays / lanes];
    for (int g = 0; g < beam_rays / lanes; ++g) {
        const HitLanes hit = load_hits(queue, first, active, c.scratch.hits, g);
        hit_lanes[g] = bits(hit.active);
        if (hit_lanes[g] == 0) continue;
        const int at = g * lanes, q = first + at;
        const SurfaceLanes s = surface_at(scene, hit);
        const MaterialLanes m = material_at(scene, hit, s);
        const Real weight = load(queue.weight + q), length = load(queue.length + q) + hit.t;
        store(weight, shade.weight + at);
        store(m.ambient * Real(0.2f), shade.base + at);
        store_for_lights(hit, s, m, length, g, shade);
        if (depth == depth_limit || !spawns(hit, m)) continue;
        const Int pixel = depth == 0 ? lane_numbers() + Int(at) : load(queue.pixel + q);
        spawn(hit, s, m, length, weight, load(queue.medium + q), pixel, next, c.counts);
    }
    light_hits(scene, c.job.settings, c.sample, depth == 0, shade, c.scratch.shadow, c.counts);
    const std::int32_t* pixel = depth == 0 ? nullptr : queue.pixel + first;
    for (int g = 0; g < beam_rays / lanes; ++g)
        if (hit_lanes[g] != 0) add_radiance(shade, hit_lanes[g], g, pixel, c.scratch.radiance);
}

// All rays of one reflected or refracted level, 64 at a time.
void trace_level(const SampleContext& c, int depth) {
    RayQueue& queue = c.scratch.queues[depth & 1];
    c.scratch.queues[(depth + 1) & 1].size = 0;
    for (int first = 0; first < queue.size; first += beam_rays) {
        const int count = queue.size - first;
        const std::uint64_t active = count >= beam_rays ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
        std::uint64_t alone = active;
        if (depth == 1 && c.camera.common_origin)
            alone &= ~intersect_mirrored(*c.job.scene, c.camera.eye, queue, first, active, c.scratch);
        intersect_queued(*c.job.scene, queue, first, alone, c.scratch);
        shade_hits(c, depth, first, active);
    }
}

// Adds the finished sample to the film; values that are not finite are dropped and counted.
void add_sample(const SampleContext& c, std::uint64_t active, FilmTile& tile) {
    const float(*radiance)[beam_rays] = c.scratch.radiance;
    for (int g = 0; g < beam_rays / lanes; ++g) {
        const int at = g * lanes;
        const Vec3 value = load3(radiance, at);
        const Mask finite = is_finite(value.x) & is_finite(value.y) & is_finite(value.z);
        const Mask inside = mask_of_bits(lanes_of(active, g));
        c.counts.dropped_samples += static_cast<std::uint64_t>(std::popcount(bits(and_not(finite, inside))));
        const Real zero(0.0f);
        const Vec3 added = select(finite & inside, value, Vec3{zero, zero, zero});
        store3(load3(tile.rgb, at) + added, tile.rgb, at);
    }
}

}  // namespace

void trace_tile(const TileJob& job, TileScratch& scratch, FilmTile& tile, RayCounts& counts) {
    const TileCamera camera = make_tile_camera(job);
    for (std::uint32_t i = 0; i < job.sample_count; ++i) {
        const SampleContext c = {job, camera, job.first_sample + i, scratch, counts};
        const std::uint64_t active = make_camera_rays(c);
        counts.camera += static_cast<std::uint64_t>(std::popcount(active));
        for (int at = 0; at < beam_rays; at += lanes)
            for (auto& channel : scratch.radiance) store(Real(0.0f), channel + at);

        if (camera.common_origin)
            intersect_beam(*job.scene, scratch.camera_beam, active, scratch.hits);
        else
            intersect_queued(*job.scene, scratch.queues[0], 0, active, scratch);
        scratch.queues[1].size = 0;
        shade_hits(c, 0, 0, active);
        for (int depth = 1; depth <= depth_limit && scratch.queues[depth & 1].size > 0; ++depth) trace_level(c, depth);
        add_sample(c, active, tile);
    }
}

void resolve_tile(const FilmTile& tile, float scale, int columns, int rows, std::uint32_t* out, int row_stride) {
    resolve_pixels(tile, scale, columns, rows, out, row_stride);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
