// What the kernels keep between calls for one thread: the hits being shaded and the rays to come. Plain arrays, the
// same for every instruction set.
#pragma once

#include <cstdint>

#include "tracer/kernels/kernels.h"
#include "tracer/kernels/traversal/ray_packet.h"
#include "tracer/picture/tile_camera.h"

namespace raywalk {

// 64 hits on their way through shading. The arrays come first: each is whole registers.
struct alignas(64) ShadeBatch {
    float position[3][packet_size], normal[3][packet_size], geometric_normal[3][packet_size];
    float view[3][packet_size];  // unit, to where the ray came from
    float color[3][packet_size];
    float colored[packet_size];  // 0 where the colour is black, else 1
    float specular_weight[packet_size];
    std::int32_t shininess[packet_size];
    float length[packet_size];   // of the path from the eye to the hit
    float offset[packet_size];   // of spawned rays from the surface
    float lift[3][packet_size];  // of `lifted` hits: SurfaceLanes::lift
    float base[packet_size];     // radiance that needs no light
    float weight[packet_size];   // of the hit in its pixel

    float diffuse[packet_size], specular[packet_size];          // from the light point at hand
    float diffuse_sum[packet_size], specular_sum[packet_size];  // from the light at hand
    float local[3][packet_size];                                // from all lights

    std::uint64_t lit;      // hits that can receive light
    std::uint64_t lifted;   // those of smooth triangles that lie below the curved surface
    bool all_fifth_powers;  // no other shininess among them
};

inline constexpr int depth_limit = 5;  // of reflections and refractions

// Rays of one level. A hit makes at most two rays, one mirrored and one refracted.
inline constexpr int queue_capacity = packet_size << depth_limit;

// Arrays end in room for one more register: compressed stores write whole ones.
struct alignas(64) RayQueue {
    float origin[3][queue_capacity + packet_size], direction[3][queue_capacity + packet_size];  // unit directions
    float length[queue_capacity + packet_size];                                                 // of the path so far
    float weight[queue_capacity + packet_size];         // of the ray's radiance in its pixel
    float medium[queue_capacity + packet_size];         // refraction index around the ray
    std::int32_t pixel[queue_capacity + packet_size];   // lane of the tile
    std::int32_t mirror[queue_capacity + packet_size];  // shape id of the planar mirror that a camera ray met, else -1
    int size = 0;
};

struct TileScratch {
    RayQueue queues[2];
    ShadeBatch shade;
    BeamRays camera_beam, beam, shadow;
    RayPacket packet;
    HitPacket hits, some_hits;
    alignas(64) float radiance[3][packet_size];  // of the sample at hand
};

// Sample `sample` of a tile: what every step of it needs.
struct SampleContext {
    const TileJob& job;
    const TileCamera& camera;
    std::uint32_t sample;
    TileScratch& scratch;
    RayCounts& counts;
};

}  // namespace raywalk
