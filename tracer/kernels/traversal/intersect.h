// Rays against the compiled scene: the doors of traversal, one set per instruction set.
#pragma once

#include <cstdint>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/traversal/ray_packet.h"

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Nearest hits of the `active` rays (bit l: ray l) of a beam; the other lanes of `hits` become misses.
void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, HitPacket& hits);

// Which of the `active` rays meet anything at t in (t_min, t_max). `together`: many go nearly one way, so that beams
// pay off; the answer is the same.
std::uint64_t occluded_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, bool together);

// The same for rays that share neither origin nor direction.
void intersect_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active, HitPacket& hits);
std::uint64_t occluded_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active);

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
