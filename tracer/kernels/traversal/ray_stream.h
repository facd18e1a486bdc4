// Up to 64 rays that share neither origin nor direction, made ready for traversal sixteen at a time.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/traversal/packet_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Component by component, ray by ray. What is the same for all lanes of a test against sixteen shapes is read from here
// and spread where it is used, which costs nothing.
struct alignas(64) RayStream {
    float origin[3][packet_size], direction[3][packet_size];
    float t_min[packet_size];
    float inverse_squared_length[packet_size];  // 1 / direction . direction
    float growth[packet_size];                  // growth_of
    // Slabs: t = bound * reciprocal - near or far offset, boxes grown by the padding.
    float reciprocal[3][packet_size], near_offset[3][packet_size], far_offset[3][packet_size];
    float padding[3][packet_size];            // in t
    std::int32_t near_bound[3][packet_size];  // floats from the start of a BvhNode
    std::uint64_t rises[3] = {};              // which rays do along the axis, rather than fall
};

// Largest coordinate of everything in the hierarchy, in magnitude.
inline float scene_reach(const CompiledScene& scene) {
    float largest = 0;
    for (int a = 0; a < 3; ++a)
        largest =
            std::max({largest, std::fabs(scene.hierarchy.bounds.lower[a]), std::fabs(scene.hierarchy.bounds.upper[a])});
    return largest;
}

// By how much triangles grow for a ray (triangle_growth), in the units of TriangleForms::spread . direction.
HWY_INLINE Real growth_of(Vec3 direction) {
    return (abs(direction.x) + abs(direction.y) + abs(direction.z)) * Real(triangle_growth);
}

// Rays [16 group, 16 group + 16) of the stream. `reach`: scene_reach.
HWY_INLINE void prepare_rays(Vec3 origin, Vec3 direction, Real t_min, float reach, int group, RayStream& stream) {
    const int at = group * lanes;
    const Real padding = max(max(abs(origin.x), abs(origin.y)), max(abs(origin.z), Real(reach))) * Real(box_padding);
    store3(origin, stream.origin, at);
    store3(direction, stream.direction, at);
    const Real o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    for (int a = 0; a < 3; ++a) {
        const Mask usable = abs(d[a]) >= Real(smallest_direction);
        const Real safe = select(usable, d[a], copy_sign(Real(smallest_direction), d[a]));
        const Real reciprocal = Real(1.0f) / safe, offset = o[a] * reciprocal;
        const Real padding_in_t = padding * abs(reciprocal);
        store(reciprocal, stream.reciprocal[a] + at);
        store(padding_in_t, stream.padding[a] + at);
        store(offset + padding_in_t, stream.near_offset[a] + at);
        store(offset - padding_in_t, stream.far_offset[a] + at);
        const Int lower(a * lanes), upper((3 + a) * lanes);
        const Mask rises = safe > Real(0.0f);
        store(select(rises, lower, upper), stream.near_bound[a] + at);
        stream.rises[a] |= rays_of(rises, group);
    }
    store(Real(1.0f) / dot(direction, direction), stream.inverse_squared_length + at);
    store(growth_of(direction), stream.growth + at);
    store(t_min, stream.t_min + at);
}

// One ray of a stream.
struct SingleRay {
    const RayStream& stream;
    int i;

    [[nodiscard]] HWY_INLINE Vec3 origin() const {
        return {Real(stream.origin[0][i]), Real(stream.origin[1][i]), Real(stream.origin[2][i])};
    }
    [[nodiscard]] HWY_INLINE Vec3 direction() const {
        return {Real(stream.direction[0][i]), Real(stream.direction[1][i]), Real(stream.direction[2][i])};
    }
    [[nodiscard]] HWY_INLINE Real t_min() const { return Real(stream.t_min[i]); }
};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
