// Arrays that vector loads may touch: sixteen floats at a time, 64-byte aligned, as wide as the widest register.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace raywalk {

inline constexpr int lanes = 16;
inline constexpr std::size_t vector_alignment = 64;

template <class T>
struct AlignedAllocator {
    using value_type = T;
    AlignedAllocator() = default;
    template <class U>
    AlignedAllocator(const AlignedAllocator<U>&) noexcept {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{vector_alignment}));
    }
    void deallocate(T* p, std::size_t) noexcept { ::operator delete (p, std::align_val_t{vector_alignment}); }
    friend bool operator==(const AlignedAllocator&, const AlignedAllocator&) { return true; }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace raywalk
