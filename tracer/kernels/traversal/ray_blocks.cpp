#include "tracer/kernels/traversal/ray_blocks.h"

#include <algorithm>
#include <limits>

namespace raywalk {

RayBlocks::RayBlocks(std::size_t rays) : size_(rays), blocks_((rays + beam_rays - 1) / beam_rays) {
    for (ScatteredRays& block : blocks_) block = {};
    for (std::size_t i = 0; i < rays; ++i) t_max(i) = std::numeric_limits<float>::infinity();
}

HitBlocks::HitBlocks(std::size_t rays) : size_(rays), blocks_((rays + beam_rays - 1) / beam_rays) {
    for (BeamHits& block : blocks_) std::fill_n(block.id, beam_rays, -1);
}

void HitBlocks::set(std::size_t i, const RayHit& hit) {
    BeamHits& block = blocks_[i / beam_rays];
    const std::size_t lane = i % beam_rays;
    block.t[lane] = hit.t, block.u[lane] = hit.u, block.v[lane] = hit.v, block.id[lane] = hit.id;
}

}  // namespace raywalk
