// The rays of a packet as masks of lanes, group by group, and stores that touch only some of them.
#pragma once

#include <cstdint>

#include "tracer/kernels/lanes/lanes.h"
#include "tracer/kernels/traversal/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

HWY_INLINE Mask mask_of(std::uint64_t rays, int group) { return mask_of_bits(lanes_of(rays, group)); }
using raywalk::rays_of;
HWY_INLINE std::uint64_t rays_of(Mask of_group, int group) { return rays_of(bits(of_group), group); }

// The lanes of `some` become `value`; the others stay.
template <class Lanes, class Number>
HWY_INLINE void store_some(Mask some, Lanes value, Number* to) {
    store(select(some, value, load(to)), to);
}

// The hits of `rays`, and no others, become those in `from`.
inline void copy_hits(std::uint64_t rays, const HitPacket& from, HitPacket& to) {
    for (int g = 0; g < packet_groups; ++g) {
        const int at = g * lanes;
        const Mask some = mask_of(rays, g);
        store_some(some, load(from.t + at), to.t + at);
        store_some(some, load(from.u + at), to.u + at);
        store_some(some, load(from.v + at), to.v + at);
        store_some(some, load(from.id + at), to.id + at);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
