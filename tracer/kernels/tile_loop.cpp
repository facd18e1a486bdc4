// A tile of 8x8 pixels, traced level by level: camera rays, then all rays that they spawned, and so on. Radiance is a
// sum of weighted terms, so no recursion is needed; queues hold the rays of the next level.
#include "tracer/kernels/tile_loop.h"

#include <bit>
#include <cstdint>

#include "tracer/kernels/shading/camera_rays.h"
#include "tracer/kernels/shading/resolve.h"
#include "tracer/kernels/tile_scratch.h"
#include "tracer/kernels/traversal/intersect.h"
#include "tracer/kernels/traversal/mirror_beam.h"
#include "tracer/kernels/traversal/packet_lanes.h"
#include "tracer/kernels/whitted/shade.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// The camera rays of the tile, as queue entries 0 to 63 in pixel order; returns those inside the picture.
std::uint64_t make_camera_rays(const SampleContext& c) {
    RayQueue& queue = c.scratch.queues[0];
    BeamRays& beam = c.scratch.camera_beam;
    std::uint64_t active = 0;
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const CameraRays rays = camera_rays(c.camera, g, c.sample, c.job.settings.seed);
        store3(rays.origin, queue.origin, at);
        store3(rays.direction, queue.direction, at);
        store3(rays.direction, beam.direction, at);
        store(Real(0.0f), beam.t_min + at);
        store(Real(farthest), beam.t_max + at);
        store(Real(0.0f), queue.length + at);
        store(Real(1.0f), queue.weight + at);
        store(Real(1.0f), queue.medium + at);
        active |= rays_of(inside_picture(c.camera, g), g);
    }
    for (int axis = 0; axis < 3; ++axis) beam.origin[axis] = c.camera.eye[axis];
    return active;
}

// Rays of the queue from `first` on that share no origin; scratch.hits of the others stays.
void intersect_queued(const CompiledScene& scene, const RayQueue& queue, int first, std::uint64_t active,
                      TileScratch& scratch) {
    if (active == 0) return;
    RayPacket& rays = scratch.packet;
    for (int at = 0; at < packet_size; at += lanes) {
        store3(load3(queue.origin, first + at), rays.origin, at);
        store3(load3(queue.direction, first + at), rays.direction, at);
        store(Real(0.0f), rays.t_min + at);
        store(Real(farthest), rays.t_max + at);
    }
    intersect_packet(scene, rays, active, scratch.some_hits);
    copy_hits(active, scratch.some_hits, scratch.hits);
}

// What the camera rays hit.
void trace_camera_rays(const SampleContext& c, std::uint64_t active) {
    if (c.camera.common_origin)
        intersect_beam(*c.job.scene, c.scratch.camera_beam, active, c.scratch.hits);
    else
        intersect_queued(*c.job.scene, c.scratch.queues[0], 0, active, c.scratch);
}

// What reflected and refracted rays hit: those of the queue from `first` on. The eye's images in planar mirrors are
// common origins again.
void trace_spawned_rays(const SampleContext& c, int depth, int first, std::uint64_t active) {
    RayQueue& queue = c.scratch.queues[depth & 1];
    std::uint64_t alone = active;
    if (depth == 1 && c.camera.common_origin)
        alone &= ~intersect_mirrored(*c.job.scene, c.camera.eye, queue, first, active, c.scratch);
    intersect_queued(*c.job.scene, queue, first, alone, c.scratch);
}

// One sample of every pixel of the tile, to scratch.radiance.
void trace_sample(const SampleContext& c, std::uint64_t active) {
    for (int at = 0; at < packet_size; at += lanes)
        for (auto& channel : c.scratch.radiance) store(Real(0.0f), channel + at);
    trace_camera_rays(c, active);
    c.scratch.queues[1].size = 0;
    shade_hits(c, 0, 0, active);
    for (int depth = 1; depth <= depth_limit; ++depth) {
        const RayQueue& queue = c.scratch.queues[depth & 1];
        if (queue.size == 0) break;
        c.scratch.queues[(depth + 1) & 1].size = 0;
        for (int first = 0; first < queue.size; first += packet_size) {
            const int count = queue.size - first;
            const std::uint64_t some = count >= packet_size ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
            trace_spawned_rays(c, depth, first, some);
            shade_hits(c, depth, first, some);
        }
    }
}

// Adds the finished sample to the film; values that are not finite are dropped and counted.
void add_sample(const SampleContext& c, std::uint64_t active, FilmTile& tile) {
    const float(&radiance)[3][packet_size] = c.scratch.radiance;
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const Vec3 value = load3(radiance, at);
        const Mask finite = is_finite(value.x) & is_finite(value.y) & is_finite(value.z);
        const Mask inside = mask_of(active, g);
        c.counts.dropped_samples += static_cast<std::uint64_t>(std::popcount(bits(and_not(finite, inside))));
        const Real zero(0.0f);
        const Vec3 added = select(finite & inside, value, Vec3{zero, zero, zero});
        store3(load3(tile.rgb, at) + added, tile.rgb, at);
    }
}

}  // namespace

void trace_tile(const TileJob& job, TileScratch& scratch, FilmTile& tile, RayCounts& counts) {
    const TileCamera camera = make_tile_camera(*job.camera, job.scene->origin, job.width, job.height, job.x, job.y);
    for (std::uint32_t i = 0; i < job.sample_count; ++i) {
        const SampleContext c = {job, camera, job.first_sample + i, scratch, counts};
        const std::uint64_t active = make_camera_rays(c);
        counts.camera += static_cast<std::uint64_t>(std::popcount(active));
        trace_sample(c, active);
        add_sample(c, active, tile);
    }
}

void resolve_tile(const FilmTile& tile, float scale, int columns, int rows, std::uint32_t* out, int row_stride) {
    resolve_pixels(tile, scale, columns, rows, out, row_stride);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
