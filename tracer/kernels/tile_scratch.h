// What the kernels keep between calls for one thread: the hits being shaded and the rays to come. Plain arrays, the
// same for every instruction set.
#pragma once

#include <cstdint>

#include "tracer/kernels/kernels.h"
#include "tracer/kernels/traversal/ray_arrays.h"

namespace raywalk {

// 64 hits on their way through shading. The arrays come first: each is whole registers.
struct alignas(64) ShadeBatch {
    float position[3][beam_rays], normal[3][beam_rays], geometric_normal[3][beam_rays];
    float view[3][beam_rays];  // unit, to where the ray came from
    float color[3][beam_rays];
    float colored[beam_rays];  // 0 where the colour is black, else 1
    float specular_weight[beam_rays];
    std::int32_t shininess[beam_rays];
    float length[beam_rays];   // of the path from the eye to the hit
    float offset[beam_rays];   // of spawned rays from the surface
    float lift[3][beam_rays];  // of `lifted` hits: SurfaceLanes::lift
    float base[beam_rays];     // radiance that needs no light
    float weight[beam_rays];   // of the hit in its pixel

    float diffuse[beam_rays], specular[beam_rays];          // from the light point at hand
    float diffuse_sum[beam_rays], specular_sum[beam_rays];  // from the light at hand
    float local[3][beam_rays];                              // from all lights

    std::uint64_t lit;      // hits that can receive light
    std::uint64_t lifted;   // those of smooth triangles that lie below the curved surface
    bool all_fifth_powers;  // no other shininess among them
};

inline constexpr int depth_limit = 5;  // of reflections and refractions

// Rays of one level. A hit makes at most two rays, one mirrored and one refracted.
inline constexpr int queue_capacity = beam_rays << depth_limit;

// Arrays end in room for one more register: compressed stores write whole ones.
struct alignas(64) RayQueue {
    float origin[3][queue_capacity + beam_rays], direction[3][queue_capacity + beam_rays];  // unit directions
    float length[queue_capacity + beam_rays];                                               // of the path so far
    float weight[queue_capacity + beam_rays];         // of the ray's radiance in its pixel
    float medium[queue_capacity + beam_rays];         // refraction index around the ray
    std::int32_t pixel[queue_capacity + beam_rays];   // lane of the tile
    std::int32_t mirror[queue_capacity + beam_rays];  // shape id of the planar mirror that a camera ray met, else -1
    int size = 0;
};

struct TileScratch {
    RayQueue queues[2];
    ShadeBatch shade;
    BeamRays camera_beam, beam, shadow;
    ScatteredRays scattered;
    BeamHits hits, beam_hits;
    alignas(64) float radiance[3][beam_rays];  // of the sample at hand
};

}  // namespace raywalk
