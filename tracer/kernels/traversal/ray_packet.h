// Rays and hits as they pass between shading and traversal, a packet of 64 at a time.
#pragma once

#include <cstdint>

#include "tracer/ground/aligned.h"

namespace raywalk {

inline constexpr int packet_size = 64;  // a tile's 8x8 pixels as four groups of 4x4, film.h order
inline constexpr int packet_groups = packet_size / lanes;

// Which rays of a packet: bit i is ray i. Those of a group fill the lanes of a register.
constexpr std::uint32_t lanes_of(std::uint64_t rays, int group) {
    return static_cast<std::uint32_t>(rays >> (group * lanes)) & ((1u << lanes) - 1);
}
constexpr std::uint64_t rays_of(std::uint32_t of_group, int group) {
    return static_cast<std::uint64_t>(of_group) << (group * lanes);
}

// t_max of rays that end nowhere. Finite: a plane seen at a grazing angle may be hit at any distance, and the products
// of a ray that starts there (its origin times the largest reciprocal of a direction, 1e18) have to be finite, or the
// slab test would meet infinity minus infinity.
inline constexpr float farthest = 1e18f;

// A packet of one origin: direction[axis][ray]. Directions need not be unit: t counts in their length. Only hits with
// t_min < t < t_max count. A lane that is not active may hold anything, NaN too.
struct alignas(64) BeamRays {
    float direction[3][packet_size];
    float t_min[packet_size], t_max[packet_size];
    float origin[3];
};

// A packet that shares neither origin nor direction.
struct alignas(64) RayPacket {
    float origin[3][packet_size], direction[3][packet_size];
    float t_min[packet_size], t_max[packet_size];
};

// id: shape id of compiled_scene.h or -1; u, v: barycentric weights of corners 1 and 2 (triangles only).
struct alignas(64) HitPacket {
    float t[packet_size], u[packet_size], v[packet_size];
    std::int32_t id[packet_size];
};

// One of them.
struct RayHit {
    float t, u, v;
    std::int32_t id;
};

}  // namespace raywalk
