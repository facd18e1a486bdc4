// Any number of rays and what they hit, for tests and benchmarks: in the blocks of 64 that traversal takes, so that
// memory is read as one stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tracer/kernels/traversal/ray_packet.h"

namespace raywalk {

// Rays with t_max <= t_min are left out: they hit nothing. Directions need not be unit; t is in their length.
class RayBlocks {
  public:
    explicit RayBlocks(std::size_t rays = 0);  // t_min starts as 0, t_max as infinity
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const std::vector<RayPacket>& blocks() const { return blocks_; }
    void add(const RayPacket& block) { blocks_.push_back(block), size_ = blocks_.size() * packet_size; }

    [[nodiscard]] float origin(int axis, std::size_t i) const { return block(i).origin[axis][i % packet_size]; }
    [[nodiscard]] float direction(int axis, std::size_t i) const { return block(i).direction[axis][i % packet_size]; }
    [[nodiscard]] float t_min(std::size_t i) const { return block(i).t_min[i % packet_size]; }
    [[nodiscard]] float t_max(std::size_t i) const { return block(i).t_max[i % packet_size]; }
    float& origin(int axis, std::size_t i) { return block(i).origin[axis][i % packet_size]; }
    float& direction(int axis, std::size_t i) { return block(i).direction[axis][i % packet_size]; }
    float& t_min(std::size_t i) { return block(i).t_min[i % packet_size]; }
    float& t_max(std::size_t i) { return block(i).t_max[i % packet_size]; }

  private:
    [[nodiscard]] const RayPacket& block(std::size_t i) const { return blocks_[i / packet_size]; }
    RayPacket& block(std::size_t i) { return blocks_[i / packet_size]; }
    std::size_t size_;
    std::vector<RayPacket> blocks_;  // of the last, lanes beyond size() are left out
};

// What they hit.
class HitBlocks {
  public:
    explicit HitBlocks(std::size_t rays = 0);  // ids start as -1
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::vector<HitPacket>& blocks() { return blocks_; }

    [[nodiscard]] float t(std::size_t i) const { return blocks_[i / packet_size].t[i % packet_size]; }
    [[nodiscard]] float u(std::size_t i) const { return blocks_[i / packet_size].u[i % packet_size]; }
    [[nodiscard]] float v(std::size_t i) const { return blocks_[i / packet_size].v[i % packet_size]; }
    [[nodiscard]] std::int32_t id(std::size_t i) const { return blocks_[i / packet_size].id[i % packet_size]; }
    [[nodiscard]] RayHit hit(std::size_t i) const { return {t(i), u(i), v(i), id(i)}; }
    void set(std::size_t i, const RayHit& hit);

  private:
    std::size_t size_;
    std::vector<HitPacket> blocks_;
};

// Asks for the memory of blocks soon after block b. Who goes through blocks in order and does without waits for memory
// longer than a beam takes to be traced. (Inline at once: to GCC, calls of a function that only prefetches do nothing.)
[[gnu::always_inline]] inline void fetch_ahead(const RayBlocks& rays, HitBlocks& hits, std::size_t b) {
    constexpr std::size_t cache_line = 64, blocks_ahead = 2;
    if (b + blocks_ahead >= rays.blocks().size()) return;
    const auto* some = reinterpret_cast<const char*>(&rays.blocks()[b + blocks_ahead]);
    const auto* found = reinterpret_cast<const char*>(&hits.blocks()[b + blocks_ahead]);
    for (std::size_t at = 0; at < sizeof(RayPacket); at += cache_line) __builtin_prefetch(some + at);
    for (std::size_t at = 0; at < sizeof(HitPacket); at += cache_line) __builtin_prefetch(found + at, 1);
}

}  // namespace raywalk
