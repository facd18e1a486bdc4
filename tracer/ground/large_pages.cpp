// Large blocks of `new` lie on large pages. Memory that is touched for the first time costs a page fault, for 4 KB or
// for 2 MB: where pages are small, faults take half the time from the start to the first picture of a mesh, and
// incoherent rays wait for the translation of addresses. Vectors everywhere profit; nothing else changes, and what
// cannot be had is done without. Not replaced under a sanitizer, which checks its own.
#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "tracer/ground/sanitized.h"

#if !RAYWALK_SANITIZED

namespace {

constexpr std::size_t large_page = std::size_t{2} << 20;
constexpr std::size_t large_block = large_page / 2;  // and more is rounded up to whole large pages

void* allocate(std::size_t bytes, std::size_t alignment) {
    for (;;) {
        void* block = nullptr;
        if (bytes >= large_block && bytes < ~std::size_t{0} - large_page) {
            const std::size_t whole = (bytes + large_page - 1) / large_page * large_page;
            if (posix_memalign(&block, std::max(alignment, large_page), whole) == 0)
                madvise(block, whole, MADV_HUGEPAGE);
        } else if (alignment <= alignof(std::max_align_t)) {
            block = std::malloc(std::max<std::size_t>(bytes, 1));
        } else if (posix_memalign(&block, alignment, bytes) != 0) {
            block = nullptr;
        }
        if (block != nullptr) return block;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

}  // namespace

// The other forms of new and delete call these.
void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

#endif
