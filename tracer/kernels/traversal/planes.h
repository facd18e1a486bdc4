// Infinite planes stand outside the hierarchies: each is tested against every ray.
#pragma once

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/traversal/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Nearest planes of sixteen rays, written over what `t` and `id` hold where a plane is nearer.
HWY_INLINE void nearest_planes(const CompiledScene& scene, Vec3 origin, Vec3 direction, Real t_min, Real& t, Int& id) {
    const std::int32_t first_id = scene.triangle_count + scene.sphere_count;
    for (std::int32_t i = 0; i < scene.plane_count; ++i) {
        const PlaneRecord& plane = scene.planes[i];
        const Vec3 normal = splat3(plane.normal);
        const Real distance = Real(plane.offset) - dot(normal, origin);
        const Real at = distance / dot(normal, direction);
        const Mask nearer = (at > t_min) & (at < t);
        t = select(nearer, at, t);
        id = select(nearer, Int(first_id + i), id);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
