#include "tracer/ground/large_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace raywalk {

void ask_for_large_pages(void* memory, std::size_t bytes) noexcept {
    if (bytes < worth_large_pages) return;
    static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (address + page - 1) / page * page, end = (address + bytes) / page * page;
    madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

}  // namespace raywalk
