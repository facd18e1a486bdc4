// Camera rays reflected by a planar mirror are rays of one origin again, the eye's mirror image: they go as a beam.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/tile_scratch.h"
#include "tracer/kernels/traversal/intersect.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// t_max of rays that end nowhere. Finite: a plane seen at a grazing angle may be hit at any distance, and the products
// of a ray that starts there (its origin times the largest reciprocal of a direction, 1e18) have to be finite, or the
// slab test would meet infinity minus infinity.
inline constexpr float farthest = 1e18f;

// Fewer rays of one mirror go alone.
inline constexpr int fewest_mirrored = 8;

// The eye behind the mirror of normal n that turned a camera ray of length `length` into direction d.
inline void mirror_eye(const float eye[3], const float n[3], const float d[3], float length, float image[3]) {
    double along = 0;
    for (int axis = 0; axis < 3; ++axis) along += static_cast<double>(d[axis]) * n[axis];
    // The ray met the mirror at eye + length (d - 2 (d.n) n); its distance from the plane follows.
    double distance = 0;
    for (int axis = 0; axis < 3; ++axis) distance += n[axis] * length * (d[axis] - 2 * along * n[axis]);
    for (int axis = 0; axis < 3; ++axis) image[axis] = static_cast<float>(eye[axis] + 2 * distance * n[axis]);
}

inline const float* mirror_normal(const CompiledScene& scene, std::int32_t id) {
    return id < scene.triangle_count
               ? scene.triangles[static_cast<std::size_t>(id)].normal
               : scene.planes[static_cast<std::size_t>(id - scene.triangle_count - scene.sphere_count)].normal;
}

// The lanes of `mine` become `value`.
template <class Lanes, class Number>
HWY_INLINE void take(Mask mine, Lanes value, Number* to) {
    store(select(mine, value, load(to)), to);
}

// The hits of `rays`, and no others, become those in `from`.
inline void take_hits_of(std::uint64_t rays, const BeamHits& from, BeamHits& to) {
    for (int at = 0; at < beam_rays; at += lanes) {
        const Mask mine = mask_of_bits(static_cast<std::uint32_t>(rays >> at) & 0xffffu);
        take(mine, load(from.t + at), to.t + at);
        take(mine, load(from.u + at), to.u + at);
        take(mine, load(from.v + at), to.v + at);
        take(mine, load(from.id + at), to.id + at);
    }
}

// SurfaceRecord::triangle_error of a planar mirror, 0 of a plane.
inline float mirror_error(const CompiledScene& scene, std::int32_t mirror) {
    if (mirror >= scene.triangle_count) return 0;
    const std::int32_t surface = scene.triangles[static_cast<std::size_t>(mirror)].surface;
    return scene.surfaces[static_cast<std::size_t>(surface)].triangle_error;
}

// Intersects those of the queue's rays from `first` on that planar mirrors made, mirror by mirror; they get the eye's
// image as their origin and length 0. Returns which rays that were; scratch.hits has their hits.
inline std::uint64_t intersect_mirrored(const CompiledScene& scene, const float eye[3], RayQueue& queue, int first,
                                        std::uint64_t active, TileScratch& scratch) {
    const auto rays_where = [&](auto condition) HWY_ATTR {
        std::uint64_t result = 0;
        for (int at = 0; at < beam_rays; at += lanes)
            result |= static_cast<std::uint64_t>(bits(condition(load(queue.mirror + first + at)))) << at;
        return result;
    };
    std::uint64_t rest = active & rays_where([](Int mirror) HWY_ATTR { return mirror > Int(-1); });
    std::uint64_t done = 0;
    BeamRays& beam = scratch.beam;
    while (std::popcount(rest) >= fewest_mirrored) {
        const int one = first + std::countr_zero(rest);
        const std::int32_t mirror = queue.mirror[one];
        const std::uint64_t rays = rest & rays_where([=](Int other) HWY_ATTR { return other == Int(mirror); });
        rest &= ~rays;
        if (std::popcount(rays) < fewest_mirrored) continue;

        const float* normal = mirror_normal(scene, mirror);
        const float direction[3] = {queue.direction[0][one], queue.direction[1][one], queue.direction[2][one]};
        mirror_eye(eye, normal, direction, queue.length[one], beam.origin);
        for (int at = 0; at < beam_rays; at += lanes) {
            const int q = first + at;
            const Vec3 d = {load(queue.direction[0] + q), load(queue.direction[1] + q), load(queue.direction[2] + q)};
            const Vec3 o = {load(queue.origin[0] + q), load(queue.origin[1] + q), load(queue.origin[2] + q)};
            const Real length = load(queue.length + q);
            store(d.x, beam.direction[0] + at);
            store(d.y, beam.direction[1] + at);
            store(d.z, beam.direction[2] + at);
            // They start as far off the mirror as rays that go alone.
            const Real reach = max(max(abs(o.x), abs(o.y)), max(abs(o.z), length));
            const Real offset = max(Real(surface_offset) * reach, Real(mirror_error(scene, mirror)));
            const Real steepness = max(abs(dot(d, splat3(normal))), Real(1e-12f));
            store(length + offset / steepness, beam.t_min + at);
            store(Real(farthest), beam.t_max + at);
        }
        intersect_beam(scene, beam, rays, scratch.beam_hits);
        take_hits_of(rays, scratch.beam_hits, scratch.hits);
        for (int at = 0; at < beam_rays; at += lanes) {
            const int q = first + at;
            const Mask mine = mask_of_bits(static_cast<std::uint32_t>(rays >> at) & 0xffffu);
            for (int axis = 0; axis < 3; ++axis) take(mine, Real(beam.origin[axis]), queue.origin[axis] + q);
            take(mine, Real(0.0f), queue.length + q);
        }
        done |= rays;
    }
    return done;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
