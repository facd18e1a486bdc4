// Rays and hits as they pass between shading and traversal, 64 at a time.
#pragma once

#include <cstdint>

namespace raywalk {

inline constexpr int beam_rays = 64;  // 8x8 pixels as four groups of 4x4, film.h order

// Which of the 64 rays: bit i is ray i. Sixteen of them, by group, fill the lanes of a register.
constexpr std::uint32_t lanes_of(std::uint64_t rays, int group) {
    return static_cast<std::uint32_t>(rays >> (group * 16)) & 0xffffu;
}
constexpr std::uint64_t rays_of(std::uint32_t lanes, int group) {
    return static_cast<std::uint64_t>(lanes) << (group * 16);
}

// 64 rays of one origin: direction[axis][ray]. Directions need not be unit: t counts in their length. Only hits with
// t_min < t < t_max count. A lane that is not active may hold anything, NaN too.
struct alignas(64) BeamRays {
    float direction[3][beam_rays];
    float t_min[beam_rays], t_max[beam_rays];
    float origin[3];
};

// The same for rays that share neither origin nor direction.
struct alignas(64) ScatteredRays {
    float origin[3][beam_rays], direction[3][beam_rays];
    float t_min[beam_rays], t_max[beam_rays];
};

// id: shape id of compiled_scene.h or -1; u, v: barycentric weights of corners 1 and 2 (triangles only).
struct alignas(64) BeamHits {
    float t[beam_rays], u[beam_rays], v[beam_rays];
    std::int32_t id[beam_rays];
};

// One of them.
struct RayHit {
    float t, u, v;
    std::int32_t id;
};

}  // namespace raywalk
