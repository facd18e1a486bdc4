// Large pages for large arrays: memory that is touched for the first time costs one fault for 2 MB then rather than one
// for 4 KB, which is what reading a mesh and building over it otherwise spend a third of their time on.
#pragma once

#include <cstddef>
#include <vector>

namespace raywalk {

// Below this size it is not worth asking.
inline constexpr std::size_t worth_large_pages = std::size_t{2} << 20;

// Asks that untouched memory be given in large pages. A refusal changes nothing but speed.
void ask_for_large_pages(void* memory, std::size_t bytes) noexcept;

// Makes room for `count` elements in all, on large pages where there are many.
template <class T, class Allocator>
void reserve_large(std::vector<T, Allocator>& array, std::size_t count) {
    if (count <= array.capacity()) return;
    array.reserve(count);
    ask_for_large_pages(array.data() + array.size(), (array.capacity() - array.size()) * sizeof(T));
}

}  // namespace raywalk
