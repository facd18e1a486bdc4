// The two hierarchies over leaf blocks: the report's SAH kd-tree and a BVH of 16 children.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <variant>

#include "tracer/compiled/leaf_blocks.h"
#include "tracer/ground/aligned.h"
#include "tracer/ground/bounds.h"

namespace raywalk {

// What is built over. Planes are infinite and stand outside.
struct TriangleCorners {
    glm::vec3 p[3];
};
struct SphereShape {
    glm::vec3 center;
    float radius;
};
struct Shapes {
    std::span<const TriangleCorners> triangles;
    std::span<const SphereShape> spheres;
};

// 8 bytes. Inner: split plane; data = (index of the lower child) << 2 | axis, the upper child follows the lower.
// Leaf: data = (index into KdTree::leaves) << 2 | 3.
struct KdNode {
    float split = 0;
    std::uint32_t data = 3;
    [[nodiscard]] bool leaf() const { return (data & 3) == 3; }
    [[nodiscard]] int axis() const { return static_cast<int>(data & 3); }
    [[nodiscard]] std::uint32_t index() const { return data >> 2; }
};

// Blocks [first, first + count) of each kind.
struct KdLeaf {
    std::uint32_t first_triangle_block = 0, first_sphere_block = 0;
    std::uint32_t triangle_blocks = 0, sphere_blocks = 0;
};

// A shape is in every leaf whose cell it enters. One that only touches the plane between two cells, with its whole self
// or with an edge, may be in one of the two: a ray that runs in a split plane has to visit both sides.
struct KdTree {
    AlignedVector<KdNode> nodes;  // nodes[0] is the root; never empty
    AlignedVector<KdLeaf> leaves;
    int depth = 0;  // of the deepest leaf; the root alone has depth 0; at most KdTree::max_depth
    static constexpr int max_depth = 100;
};

// A child: an inner node's index, or a leaf: bit 31 leaf, bit 30 spheres, bits 27-29 blocks - 1, bits 0-26 first block.
struct BvhReference {
    std::uint32_t bits;  // without a first value, for traversal has thousands of them on its stack
    [[nodiscard]] bool leaf() const { return (bits >> 31) != 0; }
    [[nodiscard]] bool spheres() const { return ((bits >> 30) & 1) != 0; }
    [[nodiscard]] std::uint32_t blocks() const { return ((bits >> 27) & 7) + 1; }
    [[nodiscard]] std::uint32_t first() const { return bits & 0x07ffffffu; }
    static BvhReference inner(std::uint32_t node) { return {node}; }
    static BvhReference leaf_of(bool spheres, std::uint32_t first, std::uint32_t blocks) {
        return {0x80000000u | (spheres ? 0x40000000u : 0u) | ((blocks - 1) << 27) | first};
    }
};

// Sixteen child boxes side by side; an empty slot has lower = +inf, upper = -inf and is never entered.
struct alignas(64) BvhNode {
    float lower[3][lanes];
    float upper[3][lanes];
    std::uint32_t child[lanes];  // BvhReference bits
};

struct Bvh {
    AlignedVector<BvhNode> nodes;  // nodes[0] is the root; never empty; the inner children of a node are contiguous
    int depth = 0;                 // inner levels below the root; at most Bvh::max_depth
    static constexpr int max_depth = 60;
};

struct Hierarchy {
    std::variant<KdTree, Bvh> tree;
    AlignedVector<TriangleBlock> triangle_blocks;
    AlignedVector<SphereBlock> sphere_blocks;
    Bounds bounds;  // of everything in the blocks; empty when there is nothing
};

enum class Accelerator { kdtree, bvh };

// The costs are those of whole frames: KT from 1 to 6 and empty factors from 0.5 to 1 were timed on the dragon, the
// monster, the bunny and the teapot. Beams ask for few, large leaves and for empty space cut off early; single rays
// would have 2 and 0.85.
struct KdOptions {
    int leaf_limit = 16;             // this many shapes or fewer always make a leaf
    int depth_limit = 0;             // 0: 8 + 1.6 log2 N, at most KdTree::max_depth
    float traversal_cost = 3.0f;     // KT
    float intersection_cost = 1.0f;  // KI, of one leaf block
    float empty_factor = 0.7f;       // cost factor of a split that cuts off empty space
};

struct BuildStatistics {
    double seconds = 0;
    std::uint64_t events = 0;  // event operations: created, sorted, swept, split (kd-tree), or primitives binned (bvh)
    std::uint64_t inner_nodes = 0, leaves = 0, empty_leaves = 0, references = 0;
    int depth = 0;
    double sah_cost = 0;
    std::uint64_t bytes = 0;  // nodes, leaves and blocks
};

// Both run on the OpenMP threads there are and give the same hierarchy for any number of them.
Hierarchy build_kd_tree(const Shapes& shapes, const KdOptions& options, BuildStatistics* statistics = nullptr);
Hierarchy build_bvh(const Shapes& shapes, BuildStatistics* statistics = nullptr);

}  // namespace raywalk
