// The memory that a scene takes, counted before it is taken.
#pragma once

#include <atomic>
#include <cstdint>

#include "tracer/ground/error.h"
#include "tracer/scene/limits.h"

namespace raywalk {

class MemoryBudget {
  public:
    // limits.memory_bytes, else what small files may ask for; never more than this process may take (memory_left.h).
    explicit MemoryBudget(const Limits& limits);

    // A file of so many bytes was read: large files may ask for more.
    void allow_for_file(std::uint64_t bytes) { files_ += bytes; }

    // Counts so many bytes more. Throws InputError at `where` where the budget does not hold them: "with WHAT the scene
    // needs ...". From any thread.
    void take(std::uint64_t bytes, const SourceLocation& where, const char* what);

  private:
    [[nodiscard]] std::uint64_t most() const;

    std::uint64_t left_, asked_for_;
    std::atomic<std::uint64_t> used_ = 0, files_ = 0;
};

// What one triangle of a mesh takes until the tree is built: its corners, its record, the builder's references, its
// share of nodes and blocks; and what it takes more with interpolated normals. Measured 180 to 230 bytes.
inline constexpr std::uint64_t memory_of_a_triangle = 240, memory_of_normals = 72;
// Of a texture: as it is read, and among the others.
inline constexpr std::uint64_t memory_of_a_texel = 8;

}  // namespace raywalk
