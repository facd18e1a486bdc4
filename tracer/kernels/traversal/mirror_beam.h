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
#include "tracer/kernels/traversal/packet_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

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
        for (int g = 0; g < packet_groups; ++g) result |= rays_of(condition(load(queue.mirror + first + g * lanes)), g);
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
        for (int at = 0; at < packet_size; at += lanes) {
            const int q = first + at;
            const Vec3 d = load3(queue.direction, q), o = load3(queue.origin, q);
            const Real length = load(queue.length + q);
            store3(d, beam.direction, at);
            // They start as far off the mirror as rays that go alone.
            const Real reach = max(max(abs(o.x), abs(o.y)), max(abs(o.z), length));
            const Real offset = max(Real(surface_offset) * reach, Real(mirror_error(scene, mirror)));
            const Real steepness = max(abs(dot(d, splat3(normal))), Real(1e-12f));
            store(length + offset / steepness, beam.t_min + at);
            store(Real(farthest), beam.t_max + at);
        }
        intersect_beam(scene, beam, rays, scratch.some_hits);
        copy_hits(rays, scratch.some_hits, scratch.hits);
        for (int g = 0; g < packet_groups; ++g) {
            const int q = first + g * lanes;
            const Mask mine = mask_of(rays, g);
            for (int axis = 0; axis < 3; ++axis) store_some(mine, Real(beam.origin[axis]), queue.origin[axis] + q);
            store_some(mine, Real(0.0f), queue.length + q);
        }
        done |= rays;
    }
    return done;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
