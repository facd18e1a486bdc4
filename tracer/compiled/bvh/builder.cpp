// The BVH of sixteen children: two binary trees, one for each kind of shape, collapsed under one root.
#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <utility>

#include "tracer/compiled/block_fill.h"
#include "tracer/compiled/bvh/binning.h"
#include "tracer/compiled/hierarchy.h"
#include "tracer/compiled/shape_bounds.h"

namespace raywalk {

namespace bvh {
namespace {

template <class Shape>
Primitives primitives_of(std::span<const Shape> shapes) {
    Primitives primitives{std::make_unique_for_overwrite<Primitive[]>(shapes.size()),
                          static_cast<std::uint32_t>(shapes.size())};
    bool all_finite = true;
#pragma omp parallel for schedule(static) reduction(&& : all_finite)
    for (std::uint32_t i = 0; i < primitives.count; ++i) {
        const Bounds box = bounds_of(shapes[i]);
        primitives.shapes[i] = {
            {box.lower.x, box.lower.y, box.lower.z}, i | Primitive::tag, {box.upper.x, box.upper.y, box.upper.z}, 0};
        all_finite = all_finite && finite(shapes[i]);
    }
    if (!all_finite) {
        Primitive* const begin = primitives.shapes.get();
        Primitive* const end = std::remove_if(begin, begin + primitives.count,
                                              [&](const Primitive& p) { return !finite(shapes[p.id()]); });
        primitives.count = static_cast<std::uint32_t>(end - begin);
    }
    return primitives;
}

// A child box with room for the rounding of the slab test, so that a ray in a flat box's plane does not miss it.
Bounds with_room(const Bounds& box) {
    Bounds wide;
    for (int axis = 0; axis < 3; ++axis) {
        const double room = rounding_margin / 2 * std::max(std::fabs(box.lower[axis]), std::fabs(box.upper[axis]));
        wide.lower[axis] = round_down(box.lower[axis] - room);
        wide.upper[axis] = round_up(box.upper[axis] + room);
    }
    return wide;
}

BvhNode empty_node() {
    BvhNode node;
    for (int axis = 0; axis < 3; ++axis) {
        std::fill(std::begin(node.lower[axis]), std::end(node.lower[axis]), std::numeric_limits<float>::infinity());
        std::fill(std::begin(node.upper[axis]), std::end(node.upper[axis]), -std::numeric_limits<float>::infinity());
    }
    std::fill(std::begin(node.child), std::end(node.child), 0u);
    return node;
}

// A range of one of the two trees.
struct Part {
    const BinaryTree* tree;
    Range range;
    double area;  // -1 once it cannot be opened
};

struct LeafRange {
    const BinaryTree* tree;
    std::uint32_t begin, end, first_block;
};

class Collapse {
  public:
    Collapse(const BinaryTree& triangles, const BinaryTree& spheres, BuildStatistics& statistics)
        : triangles_(triangles), statistics_(statistics) {
        std::vector<Part> parts;
        for (const BinaryTree* tree : {&triangles, &spheres})
            if (tree->root.size() > 0) parts.push_back(part(tree, tree->root));
        nodes.push_back(empty_node());
        write(0, std::move(parts), 0);
    }

    AlignedVector<BvhNode> nodes;
    std::vector<LeafRange> leaves;
    std::uint32_t triangle_blocks = 0, sphere_blocks = 0;

  private:
    static Part part(const BinaryTree* tree, const Range& range) {
        return {tree, range, range.leaf() ? -1 : half_area(range.box)};
    }

    // Opens the child of largest area until sixteen stand side by side or all are leaves.
    static void open(std::vector<Part>& parts) {
        while (parts.size() < lanes) {
            const auto largest = std::max_element(parts.begin(), parts.end(),
                                                  [](const Part& a, const Part& b) { return a.area < b.area; });
            if (largest == parts.end() || largest->area < 0) return;
            const Part opened = *largest;
            *largest = part(opened.tree, opened.tree->half(opened.range, 0));
            parts.push_back(part(opened.tree, opened.tree->half(opened.range, 1)));
        }
    }

    void write(std::uint32_t index, std::vector<Part> parts, int depth) {
        open(parts);
        statistics_.inner_nodes += 1;
        statistics_.depth = std::max(statistics_.depth, depth);
        BvhNode node = empty_node();
        // Should a ray of NaNs enter an empty slot, it finds a leaf there rather than its way back to the root.
        std::fill(std::begin(node.child), std::end(node.child),
                  BvhReference::leaf_of(triangles_.root.size() == 0, 0, 1).bits);
        auto next_child = static_cast<std::uint32_t>(nodes.size());
        std::vector<std::pair<std::uint32_t, Part>> inner;
        for (std::size_t slot = 0; slot < parts.size(); ++slot) {
            const Bounds box = with_room(parts[slot].range.box);
            for (int axis = 0; axis < 3; ++axis) {
                node.lower[axis][slot] = box.lower[axis];
                node.upper[axis][slot] = box.upper[axis];
            }
            if (parts[slot].range.leaf()) {
                node.child[slot] = add_leaf(parts[slot]).bits;
            } else {
                node.child[slot] = BvhReference::inner(next_child).bits;
                inner.emplace_back(next_child++, parts[slot]);
                statistics_.sah_cost += parts[slot].area;
            }
        }
        nodes[index] = node;
        nodes.resize(next_child);
        for (const auto& [child, p] : inner) write(child, {p}, depth + 1);
    }

    BvhReference add_leaf(const Part& p) {
        const bool spheres = p.tree != &triangles_;
        const std::uint32_t blocks = blocks_for(p.range.size());
        std::uint32_t& next_block = spheres ? sphere_blocks : triangle_blocks;
        leaves.push_back({p.tree, p.range.begin, p.range.end, next_block});
        const BvhReference reference = BvhReference::leaf_of(spheres, next_block, blocks);
        next_block += blocks;
        statistics_.leaves += 1;
        statistics_.references += p.range.size();
        statistics_.sah_cost += half_area(p.range.box) * blocks;
        return reference;
    }

    const BinaryTree& triangles_;
    BuildStatistics& statistics_;
};

}  // namespace
}  // namespace bvh

Hierarchy build_bvh(const Shapes& shapes, BuildStatistics* statistics) {
    const auto begin = std::chrono::steady_clock::now();
    if (shapes.triangles.size() + shapes.spheres.size() > (std::size_t{1} << 27))
        throw std::length_error("more than 134 million shapes do not fit a BVH");
    const bvh::BinaryTree triangles = bvh::build_binary(bvh::primitives_of(shapes.triangles));
    const bvh::BinaryTree spheres = bvh::build_binary(bvh::primitives_of(shapes.spheres));

    BuildStatistics counted;
    bvh::Collapse collapse(triangles, spheres, counted);
    Hierarchy hierarchy;
    hierarchy.bounds.extend(triangles.root.box);
    hierarchy.bounds.extend(spheres.root.box);
    if (!hierarchy.bounds.empty()) {
        hierarchy.bounds = with_margin(hierarchy.bounds);
        counted.sah_cost = 1 + counted.sah_cost / half_area(hierarchy.bounds);
    }
    hierarchy.triangle_blocks.resize(collapse.triangle_blocks);
    hierarchy.sphere_blocks.resize(collapse.sphere_blocks);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < collapse.leaves.size(); ++i) {
        const bvh::LeafRange& leaf = collapse.leaves[i];
        std::uint32_t ids[bvh::largest_leaf];
        for (std::uint32_t k = leaf.begin; k < leaf.end; ++k)
            ids[k - leaf.begin] = leaf.tree->primitives.shapes[k].id();
        const std::span<const std::uint32_t> of_leaf(ids, leaf.end - leaf.begin);
        if (leaf.tree == &triangles)
            fill_blocks(hierarchy.triangle_blocks.data() + leaf.first_block, of_leaf, shapes.triangles);
        else
            fill_blocks(hierarchy.sphere_blocks.data() + leaf.first_block, of_leaf, shapes.spheres, 0);
    }
    Bvh tree;
    tree.nodes = std::move(collapse.nodes);
    tree.depth = counted.depth;
    counted.events = triangles.binned + spheres.binned;
    counted.bytes = tree.nodes.size() * sizeof(BvhNode) + hierarchy.triangle_blocks.size() * sizeof(TriangleBlock) +
                    hierarchy.sphere_blocks.size() * sizeof(SphereBlock);
    hierarchy.tree = std::move(tree);
    counted.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (statistics != nullptr) *statistics = counted;
    return hierarchy;
}

}  // namespace raywalk
