#include "tracer/kernels/traversal/ray_blocks.h"

#include <algorithm>
#include <limits>

namespace raywalk {

RayBlocks::RayBlocks(std::size_t rays) : size_(rays), blocks_((rays + packet_size - 1) / packet_size) {
    for (RayPacket& block : blocks_) block = {};
    for (std::size_t i = 0; i < rays; ++i) t_max(i) = std::numeric_limits<float>::infinity();
}

HitBlocks::HitBlocks(std::size_t rays) : size_(rays), blocks_((rays + packet_size - 1) / packet_size) {
    for (HitPacket& block : blocks_) std::fill_n(block.id, packet_size, -1);
}

void HitBlocks::set(std::size_t i, const RayHit& hit) {
    HitPacket& block = blocks_[i / packet_size];
    const std::size_t lane = i % packet_size;
    block.t[lane] = hit.t, block.u[lane] = hit.u, block.v[lane] = hit.v, block.id[lane] = hit.id;
}

}  // namespace raywalk
