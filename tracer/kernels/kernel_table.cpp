// The table of one instruction set's kernels.
#include <algorithm>
#include <vector>

#include "tracer/kernels/kernels.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/tile_loop.h"
#include "tracer/kernels/traversal/intersect.h"
#include "tracer/kernels/traversal/packet_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// Which rays of the block are not left out.
std::uint64_t taking_part(const RayPacket& rays) {
    std::uint64_t active = 0;
    for (int g = 0; g < packet_groups; ++g)
        active |= rays_of(load(rays.t_max + g * lanes) > load(rays.t_min + g * lanes), g);
    return active;
}

// The same rays, which have the origin of `origin`'s ray 0 in common.
void copy_to_beam(const RayPacket& rays, const RayPacket& origin, BeamRays& beam) {
    for (int at = 0; at < packet_size; at += lanes) {
        store3(load3(rays.direction, at), beam.direction, at);
        store(load(rays.t_min + at), beam.t_min + at);
        store(load(rays.t_max + at), beam.t_max + at);
    }
    for (int axis = 0; axis < 3; ++axis) beam.origin[axis] = origin.origin[axis][0];
}

// Asks `trace` for the hits of every block with rays that take part.
template <class Trace>
void trace_blocks(const RayBlocks& rays, HitBlocks& hits, Trace trace) {
    const std::vector<RayPacket>& blocks = rays.blocks();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        HitPacket& found = hits.blocks()[b];
        fetch_ahead(rays, hits, b);
        if (const std::uint64_t active = taking_part(blocks[b]); active != 0)
            trace(blocks[b], active, found);
        else
            std::fill_n(found.id, packet_size, -1);
    }
}

void note_blocked(std::uint64_t blocked, HitPacket& hits) {
    for (int g = 0; g < packet_groups; ++g) store(select(mask_of(blocked, g), Int(0), Int(-1)), hits.id + g * lanes);
}

void intersect_blocks(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits) {
    trace_blocks(rays, hits, [&](const RayPacket& some, std::uint64_t active, HitPacket& found) {
        intersect_packet(scene, some, active, found);
    });
}

void intersect_blocks_as_beams(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits) {
    BeamRays beam;
    trace_blocks(rays, hits, [&](const RayPacket& some, std::uint64_t active, HitPacket& found) {
        copy_to_beam(some, rays.blocks().front(), beam);
        intersect_beam(scene, beam, active, found);
    });
}

void occlude_blocks(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits) {
    trace_blocks(rays, hits, [&](const RayPacket& some, std::uint64_t active, HitPacket& found) {
        note_blocked(occluded_packet(scene, some, active), found);
    });
}

void occlude_blocks_as_beams(const CompiledScene& scene, const RayBlocks& rays, HitBlocks& hits) {
    BeamRays beam;
    trace_blocks(rays, hits, [&](const RayPacket& some, std::uint64_t active, HitPacket& found) {
        copy_to_beam(some, rays.blocks().front(), beam);
        note_blocked(occluded_beam(scene, beam, active, true), found);
    });
}

}  // namespace

extern const Kernels kernels;
const Kernels kernels = {
#if HWY_TARGET == HWY_AVX3
    .name = "avx512",
#elif HWY_TARGET == HWY_AVX2
    .name = "avx2",
#elif HWY_TARGET == HWY_SSE4
    .name = "sse4",
#else
    .name = "scalar",
#endif
    .lanes = register_lanes,
    .trace_tile = trace_tile,
    .resolve_tile = resolve_tile,
    .intersect = intersect_blocks,
    .intersect_beam = intersect_blocks_as_beams,
    .occluded = occlude_blocks,
    .occluded_beam = occlude_blocks_as_beams,
};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
