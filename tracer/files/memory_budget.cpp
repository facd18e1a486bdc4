#include "tracer/files/memory_budget.h"

#include <algorithm>
#include <string>

#include "tracer/ground/memory_left.h"

namespace raywalk {

namespace {

// What a scene may take however small its files are, and how much more for each of their bytes. Honest meshes take some
// 10 bytes a byte of their file; one that is named a hundred times, or a packed picture of one colour, far more.
constexpr std::uint64_t of_small_files = std::uint64_t{4} << 30, of_a_byte = 100;

std::string megabytes(std::uint64_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MB"; }

}  // namespace

MemoryBudget::MemoryBudget(const Limits& limits) : left_(memory_left()), asked_for_(limits.memory_bytes) {}

std::uint64_t MemoryBudget::most() const {
    if (asked_for_ != 0) return std::min(left_, asked_for_);
    return std::min(left_, of_small_files + of_a_byte * files_);
}

void MemoryBudget::take(std::uint64_t bytes, const SourceLocation& where, const char* what) {
    const std::uint64_t before = used_.fetch_add(bytes), most = this->most();
    if (before <= most && bytes <= most - before) return;
    used_ -= bytes;
    throw InputError(
        error_at(where,
                 std::string("with ") + what + " the scene needs " + megabytes(before + bytes) +
                     " of memory, and may take " + megabytes(most),
                 "use smaller files, or let it have more (--max-memory BYTES, ulimit -v, the container's limit)"));
}

}  // namespace raywalk
