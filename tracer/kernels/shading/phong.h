// Light that hits receive from the lights they see (spec 4.4): 64 hits at a time, one shadow beam per point of light.
#pragma once

#include <bit>
#include <cstdint>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/kernels/lanes/math.h"
#include "tracer/kernels/lanes/random.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/tile_scratch.h"
#include "tracer/kernels/traversal/intersect.h"
#include "tracer/kernels/traversal/packet_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

inline constexpr float attenuation = 0.02f;  // mu, per scene unit

// What each hit of `shade.lit` would receive from a light at `light` if it sees it, per unit of the light's radiance:
// shade.diffuse and shade.specular; and the shadow rays that tell, from the light to the hits. Returns which of the
// hits would receive anything.
HWY_INLINE std::uint64_t face_light(const float light[3], ShadeBatch& shade, BeamRays& shadow) {
    for (int axis = 0; axis < 3; ++axis) shadow.origin[axis] = light[axis];
    std::uint64_t receiving = 0;
    for (int g = 0; g < packet_groups; ++g) {
        const std::uint32_t lit = lanes_of(shade.lit, g);
        if (lit == 0) continue;
        const int at = g * lanes;
        const Vec3 to_light = splat3(light) - load3(shade.position, at);
        const Vec3 normal = load3(shade.normal, at), view = load3(shade.view, at);
        const Real squared_distance = max(dot(to_light, to_light), Real(1e-30f));
        const Real inverse_distance = Real(1.0f) / sqrt(squared_distance);
        const Real cosine = dot(normal, to_light) * inverse_distance;  // L.N
        // R.V with R = 2 (L.N) N - L
        const Real mirrored = mul_sub(cosine * Real(2.0f), dot(normal, view), dot(to_light, view) * inverse_distance);
        const Real x = max(mirrored, Real(0.0f));
        const Real x2 = x * x;
        const Real highlight = shade.all_fifth_powers ? x2 * x2 * x : power(x, load(shade.shininess + at));
        const Real length = mul_add(squared_distance, inverse_distance, load(shade.length + at));
        const Real kept = exp(length * Real(-attenuation));
        const Real diffuse = max(cosine, Real(0.0f)) * kept * load(shade.colored + at);
        const Real specular = highlight * load(shade.specular_weight + at) * kept;
        store(diffuse, shade.diffuse + at);
        store(specular, shade.specular + at);
        receiving |= rays_of(bits(diffuse + specular > Real(0.0f)) & lit, g);

        // The shadow ray ends off the surface, on the light's side of it; that of a smooth triangle on the curved
        // surface, which is seen from the eye's side only.
        const Vec3 geometric_normal = load3(shade.geometric_normal, at);
        Vec3 to_end = -to_light, towards = to_light;
        if (const std::uint32_t lifted = lanes_of(shade.lifted, g); lifted != 0) {
            to_end = select(mask_of_bits(lifted), to_end + load3(shade.lift, at), to_end);
            towards = select(mask_of_bits(lifted), view, towards);
        }
        const Real offset = copy_sign(load(shade.offset + at), dot(geometric_normal, towards));
        store3(mul_add(geometric_normal, offset, to_end), shadow.direction, at);
    }
    return receiving;
}

// Adds one point's light, `weight` times, to the sums of those who see it.
HWY_INLINE void receive(std::uint64_t seeing, float weight, ShadeBatch& shade) {
    for (int g = 0; g < packet_groups; ++g) {
        const std::uint32_t lanes_seeing = lanes_of(seeing, g);
        if (lanes_seeing == 0) continue;
        const int at = g * lanes;
        const Mask sees = mask_of_bits(lanes_seeing);
        const auto add = [&](const float* light, float* sum) HWY_ATTR {
            store_some(sees, mul_add(load(light + at), Real(weight), load(sum + at)), sum + at);
        };
        add(shade.diffuse, shade.diffuse_sum);
        add(shade.specular, shade.specular_sum);
    }
}

// Adds what a whole light (all its points) gave, `radiance` each point, to shade.local.
HWY_INLINE void receive_light(const float radiance[3], ShadeBatch& shade) {
    for (int at = 0; at < packet_size; at += lanes) {
        const Real diffuse = load(shade.diffuse_sum + at), specular = load(shade.specular_sum + at);
        for (int channel = 0; channel < 3; ++channel) {
            const Real received = mul_add(diffuse, load(shade.color[channel] + at), specular);
            float* local = shade.local[channel] + at;
            store(mul_add(received, Real(radiance[channel]), load(local)), local);
        }
        store(Real(0.0f), shade.diffuse_sum + at);
        store(Real(0.0f), shade.specular_sum + at);
    }
}

// The points of a light that one sample uses, each with a weight; the weights add up to the number of points. All of
// them where there are few, or where the picture is made of one sample; else one of each stratum.
struct LightChoice {
    std::uint32_t used, side;  // side 0: all
};
inline LightChoice choose_points(const LightGroup& group, const SampleSettings& settings) {
    std::uint32_t side = 0;
    while (side * side < group.count) ++side;
    if (settings.one_shot || group.count <= strata || side * side != group.count) return {group.count, 0};
    return {strata, side};
}

// Whether the ends of the active shadow rays lie near each other as the light sees them: beams pay off then,
// measured 1.45 times as fast behind a planar mirror; off curved mirrors a stream is, 1.25 times.
inline bool lie_together(const BeamRays& shadow, std::uint64_t active) {
    float extent = 0, reach = 0;
    for (const auto& along : shadow.direction) {
        Real lower(__builtin_inff()), upper(-__builtin_inff());
        for (int g = 0; g < packet_groups; ++g) {
            const Mask mine = mask_of(active, g);
            const Real end = load(along + g * lanes);
            lower = select(mine, min(end, lower), lower);
            upper = select(mine, max(end, upper), upper);
        }
        const float from = reduce_min(lower), to = reduce_max(upper);
        extent = extent > to - from ? extent : to - from;
        const float farther = to > -from ? to : -from;
        reach = reach > farther ? reach : farther;
    }
    return extent <= 0.25f * reach;
}

// shade.local = light received directly by the hits of shade.lit, attenuated from light to hit to eye.
// `of_camera_rays`: they are the hits of a tile's camera rays.
inline void light_hits(const CompiledScene& scene, const SampleSettings& settings, std::uint32_t sample,
                       bool of_camera_rays, ShadeBatch& shade, BeamRays& shadow, RayCounts& counts) {
    for (int at = 0; at < packet_size; at += lanes) {
        for (auto& channel : shade.local) store(Real(0.0f), channel + at);
        store(Real(0.0f), shade.diffuse_sum + at);
        store(Real(0.0f), shade.specular_sum + at);
        store(Real(0.0f), shadow.t_min + at);
        store(Real(shadow_t_max), shadow.t_max + at);
    }
    if (shade.lit == 0) return;
    for (const LightGroup& group : scene.light_groups) {
        const LightPoint* points = scene.light_points.data() + group.first;
        const LightChoice choice = choose_points(group, settings);
        bool received = false;
        for (std::uint32_t i = 0; i < choice.used; ++i) {
            StratumCell point = {i, 1.0f};
            if (choice.side != 0) point = stratum_cell(choice.side, i, sample, settings.seed);
            const std::uint64_t receiving = face_light(points[point.cell].position, shade, shadow);
            if (receiving == 0) continue;
            counts.shadow += static_cast<std::uint64_t>(std::popcount(receiving));
            const bool together = of_camera_rays || lie_together(shadow, receiving);
            const std::uint64_t seeing = receiving & ~occluded_beam(scene, shadow, receiving, together);
            if (seeing == 0) continue;
            receive(seeing, point.cells, shade);
            received = true;
        }
        if (received) receive_light(points[0].radiance, shade);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
