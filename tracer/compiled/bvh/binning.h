// Binary BVH over one kind of shape: binned surface-area heuristic over centroids, primitives sorted in place.
// Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007.
#pragma once

#include <cstdint>
#include <memory>

#include "tracer/ground/aligned.h"
#include "tracer/ground/bounds.h"

namespace raywalk::bvh {

// A shape's box and index, in two vector registers.
struct alignas(32) Primitive {
    float lower[3];
    std::uint32_t tagged_id;  // with a bit that makes it a normal number in vector arithmetic: denormals are slow
    float upper[3];
    std::uint32_t padding;

    static constexpr std::uint32_t tag = 0x40000000u;
    [[nodiscard]] std::uint32_t id() const { return tagged_id & ~tag; }
};

struct Primitives {
    std::unique_ptr<Primitive[]> shapes;
    std::uint32_t count = 0;
};

// Primitives [begin, end) and their box; split at `middle`, or a leaf where that is 0.
struct Range {
    std::uint32_t begin = 0, end = 0, middle = 0;
    Bounds box;
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
    [[nodiscard]] bool leaf() const { return middle == 0; }
};

// What is known of the two halves of a split range. Without initial values: the array of them is sparse.
struct Halves {
    float lower[2][3], upper[2][3];  // boxes
    std::uint32_t middle[2];         // see Range
};

// The split of a range lies at its middle: no two ranges share one, so tasks write without asking each other.
struct BinaryTree {
    Primitives primitives;
    std::unique_ptr<Halves[]> split_at;  // by middle
    Range root;
    std::uint64_t binned = 0;  // primitives binned and moved, over all ranges

    // The lower (0) or upper (1) half of a range that is not a leaf.
    [[nodiscard]] Range half(const Range& range, int side) const {
        const Halves& halves = split_at[range.middle];
        const float *low = halves.lower[side], *high = halves.upper[side];
        return {side == 0 ? range.begin : range.middle,
                side == 0 ? range.middle : range.end,
                halves.middle[side],
                {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}};
    }
};

inline constexpr std::uint32_t largest_leaf = 8 * 16;  // of shapes whose centroids coincide; else one block of 16

// Sorts the primitives into a tree, by all threads.
BinaryTree build_binary(Primitives primitives);

}  // namespace raywalk::bvh
