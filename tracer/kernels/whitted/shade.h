// What hits look like (Whitted, "An improved illumination model for shaded display", 1980): the light that they
// receive, and the rays that they reflect and transmit.
#pragma once

#include <bit>
#include <cstdint>

#include "tracer/kernels/shading/phong.h"
#include "tracer/kernels/shading/surface.h"
#include "tracer/kernels/tile_scratch.h"
#include "tracer/kernels/traversal/packet_lanes.h"
#include "tracer/kernels/whitted/spawn.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

HWY_INLINE HitLanes load_hits(const RayQueue& queue, int first, std::uint64_t active, const HitPacket& hits,
                              int group) {
    const int at = group * lanes, q = first + at;
    HitLanes h;
    h.origin = load3(queue.origin, q);
    h.direction = load3(queue.direction, q);
    h.t = load(hits.t + at);
    h.u = load(hits.u + at);
    h.v = load(hits.v + at);
    h.id = load(hits.id + at);
    h.active = mask_of(active, group) & (h.id > Int(-1));
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
    shade.lifted |= rays_of(lifted, group);
    const Mask colored = max(m.color.x, max(m.color.y, m.color.z)) > zero, shiny = m.specular > zero;
    store(select(colored, Real(1.0f), zero), shade.colored + at);
    shade.lit |= rays_of(hit.active & (colored | shiny), group);
    shade.all_fifth_powers &= none(and_not(m.shininess == Int(5), hit.active & shiny));
}

// Whether a group's hits reflect or transmit anything.
HWY_INLINE bool spawns(const HitLanes& hit, const MaterialLanes& m) {
    return any(hit.active & (max(m.reflection, m.transmission) > Real(0.0f)));
}

// Queues the mirrored and refracted rays of a group's hits. Not inlined: its registers would be spilled in every loop
// over hits, where few reflect (cornell_box 1.2 to 1.3 times as fast without).
inline HWY_NOINLINE void spawn(const HitLanes& hit, const SurfaceLanes& s, const MaterialLanes& m, const Real& length,
                               const Real& weight, const Real& medium, const Int& pixel, RayQueue& next,
                               RayCounts& counts) {
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
                             float (&radiance)[3][packet_size]) {
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
    store3(value, values, 0);
    for (; hit != 0; hit &= hit - 1) {
        const int i = std::countr_zero(hit);
        for (int channel = 0; channel < 3; ++channel) radiance[channel][pixel[at + i]] += values[channel][i];
    }
}

// Shades what the rays of the queue from `first` on hit, and queues the rays of the next level.
inline void shade_hits(const SampleContext& c, int depth, int first, std::uint64_t active) {
    const CompiledScene& scene = *c.job.scene;
    const RayQueue& queue = c.scratch.queues[depth & 1];
    RayQueue& next = c.scratch.queues[(depth + 1) & 1];
    ShadeBatch& shade = c.scratch.shade;
    shade.lit = shade.lifted = 0;
    shade.all_fifth_powers = true;
    std::uint32_t hit_lanes[packet_groups];
    for (int g = 0; g < packet_groups; ++g) {
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
    for (int g = 0; g < packet_groups; ++g)
        if (hit_lanes[g] != 0) add_radiance(shade, hit_lanes[g], g, pixel, c.scratch.radiance);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
