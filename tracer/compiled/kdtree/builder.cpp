// The top of the kd-tree, built by all threads, and the tree put together from the subtrees below it.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tracer/compiled/block_fill.h"
#include "tracer/compiled/hierarchy.h"
#include "tracer/compiled/kdtree/subtree.h"
#include "tracer/compiled/shape_bounds.h"
#include "tracer/ground/task_errors.h"

namespace raywalk {

namespace kd {
namespace {

// Cells of more shapes than this are split by several threads and their children become tasks of their own. A fixed
// number: the tree may not depend on the threads.
constexpr std::uint32_t task_shapes = 4096;

// A node that owns its events and slots.
struct OwnedNode {
    Node node;
    Slots slots;
    std::array<std::unique_ptr<Event[]>, 3> storage;

    void allocate(int axis, std::size_t events) { storage[axis] = std::make_unique_for_overwrite<Event[]>(events); }
};

// The upper part of the tree: a split with two children, or a subtree.
struct Branch {
    Split split;
    std::unique_ptr<Branch> child[2];
    std::unique_ptr<Subtree> subtree;
    Counts counts;  // of this split alone
};

// Sorts the slots of a node by side and numbers them anew for each child, in the order of the split's axis.
struct Classes {
    std::vector<std::uint32_t> target;  // by slot, see distribute
    std::vector<std::uint32_t> straddlers;
    std::array<std::uint32_t, 2> sizes{0, 0};
};

Classes classify(const Node& node, const Slots& slots, const Split& split) {
    Classes classes;
    classes.target.resize(slots.shape.size());
    const auto events = node.axis(split.axis);
    for (std::uint32_t i = 0; i < split.first_upper; ++i)
        classes.target[slot_of(events[i])] =
            type_of(events[i]) == EventType::start ? straddles : to_lower | classes.sizes[0]++;
    for (std::size_t i = split.first_upper; i < events.size(); ++i) {
        std::uint32_t& target = classes.target[slot_of(events[i])];
        if (type_of(events[i]) != EventType::end)
            target = to_upper | classes.sizes[1]++;
        else if (target == straddles)
            classes.straddlers.push_back(slot_of(events[i]));
    }
    return classes;
}

// Gives each child its slots: whole shapes where `classes` says, then the parts of straddlers, whose events it makes.
void fill_slots(const Slots& from, const Classes& classes, const std::vector<Parts>& parts,
                std::array<std::uint32_t, 2> next_part, std::array<Slots*, 2> to, NewEvents& new_events) {
    for (std::size_t slot = 0; slot < classes.target.size(); ++slot) {
        const std::uint32_t target = classes.target[slot];
        if (target == straddles) continue;
        Slots& child = *to[target >> 31];
        child.shape[target & slot_mask] = from.shape[slot];
        child.box[target & slot_mask] = from.box[slot];
    }
    new_events.clear();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Bounds* box[2] = {&parts[i].lower, &parts[i].upper};
        for (int side = 0; side < 2; ++side) {
            if (box[side]->empty()) continue;
            const std::uint32_t slot = next_part[side]++;
            to[side]->shape[slot] = from.shape[classes.straddlers[i]];
            to[side]->box[slot] = *box[side];
            new_events.add(side, slot, *box[side]);
        }
    }
    new_events.sort();
}

class Builder {
  public:
    explicit Builder(const Input& input) : input_(input), workers_(static_cast<std::size_t>(omp_get_max_threads())) {}

    Branch build(OwnedNode& root) {
        Branch top;
#pragma omp parallel if (root.node.shapes > task_shapes)
#pragma omp single
        errors_.guard([&] { grow(root, top); });
        errors_.rethrow();
        return top;
    }

  private:
    void grow(OwnedNode& owned, Branch& branch) {
        if (owned.node.shapes <= task_shapes || !split(owned, branch)) {
            SubtreeBuilder& worker = workers_[static_cast<std::size_t>(omp_get_thread_num())];
            branch.subtree = std::make_unique<Subtree>(worker.build(input_, owned.slots, owned.node));
        }
    }
    using Children = std::array<std::shared_ptr<OwnedNode>, 2>;

    // False where the node had better be a leaf; else the branch and all below it are done.
    bool split(OwnedNode& owned, Branch& branch);
    [[nodiscard]] Split best_split(const Node& node) const;
    // The parts of the straddlers, in their order.
    [[nodiscard]] std::vector<Parts> clip(const OwnedNode& owned, const Classes& classes, const Split& split) const;
    // Copies and merges the events of each axis into the children.
    void distribute_events(const Node& node, const Classes& classes, const NewEvents& new_events, Children& children);
    void grow_children(Children children, Branch& branch);

    const Input& input_;
    std::vector<SubtreeBuilder> workers_;
    TaskErrors errors_;
};

Split Builder::best_split(const Node& node) const {
    std::array<Split, 3> splits;
    for (int axis = 0; axis < 3; ++axis) {
#pragma omp task shared(splits, node) firstprivate(axis)
        splits[axis] = sweep(node.axis(axis), axis, node.shapes, node.cell, input_.options);
    }
#pragma omp taskwait
    return cheapest(splits);
}

std::vector<Parts> Builder::clip(const OwnedNode& owned, const Classes& classes, const Split& split) const {
    constexpr std::size_t grain = 512;
    const std::size_t count = classes.straddlers.size();
    std::vector<Parts> parts(count);
    for (std::size_t begin = 0; begin < count; begin += grain) {
#pragma omp task shared(parts, classes, owned, split) firstprivate(begin, count)
        for (std::size_t i = begin; i < std::min(begin + grain, count); ++i) {
            const std::uint32_t slot = classes.straddlers[i];
            parts[i] = input_.split(owned.slots.shape[slot], owned.slots.box[slot], split.axis, split.position);
        }
    }
#pragma omp taskwait
    return parts;
}

void Builder::distribute_events(const Node& node, const Classes& classes, const NewEvents& new_events,
                                Children& children) {
    for (int axis = 0; axis < 3; ++axis) {
#pragma omp task shared(children, classes, node, new_events) firstprivate(axis)
        errors_.guard([&] {
            for (int side = 0; side < 2; ++side)
                children[side]->allocate(axis, 2 * std::size_t{classes.sizes[side]} + 1);
            Event* const lower = children[0]->storage[axis].get();
            Event* const upper = children[1]->storage[axis].get();
            const Distributed written =
                distribute(node.axis(axis), classes.target.data(), new_events.of(0, axis).data(),
                           new_events.of(1, axis).data(), lower, upper);
            children[0]->node.events[axis] = {lower, written.lower};
            children[1]->node.events[axis] = {upper, written.upper};
        });
    }
#pragma omp taskwait
}

bool Builder::split(OwnedNode& owned, Branch& branch) {
    const Node& node = owned.node;
    if (node.depth >= input_.depth_limit) return false;
    const Split best = best_split(node);
    if (best.cost >= input_.options.intersection_cost * leaf_cost(node.shapes)) return false;

    Classes classes = classify(node, owned.slots, best);
    const std::vector<Parts> parts = clip(owned, classes, best);
    const std::array<std::uint32_t, 2> whole = classes.sizes;
    for (const Parts& p : parts) {
        classes.sizes[0] += !p.lower.empty();
        classes.sizes[1] += !p.upper.empty();
    }
    if (std::uint64_t{classes.sizes[0]} + classes.sizes[1] > node.budget) return false;

    const std::array<Node, 2> child = children_of(node, best, classes.sizes[0], classes.sizes[1]);
    Children children{std::make_shared<OwnedNode>(), std::make_shared<OwnedNode>()};
    for (int side = 0; side < 2; ++side) {
        children[side]->node = child[side];
        children[side]->slots.shape.resize(classes.sizes[side]);
        children[side]->slots.box.resize(classes.sizes[side]);
    }
    NewEvents new_events;
    fill_slots(owned.slots, classes, parts, whole, {&children[0]->slots, &children[1]->slots}, new_events);
    distribute_events(node, classes, new_events, children);

    branch.split = best;
    branch.counts.inner_nodes = 1;
    branch.counts.cost = half_area(node.cell) * input_.options.traversal_cost;
    branch.counts.events = new_events.operations();
    for (const auto& events : node.events) branch.counts.events += 2 * events.size();
    owned = {};  // the children have everything
    grow_children(std::move(children), branch);
    return true;
}

void Builder::grow_children(Children children, Branch& branch) {
    for (int side = 0; side < 2; ++side) {
        branch.child[side] = std::make_unique<Branch>();
        Branch* const to = branch.child[side].get();
        const std::shared_ptr<OwnedNode> owned = std::move(children[side]);
#pragma omp task firstprivate(owned, to)
        errors_.guard([&] { grow(*owned, *to); });
    }
#pragma omp taskwait
}

OwnedNode root_of(const Input& input, Bounds& bounds) {
    OwnedNode root;
    const auto triangles = static_cast<std::uint32_t>(input.shapes.triangles.size());
    const auto shapes = triangles + static_cast<std::uint32_t>(input.shapes.spheres.size());
    root.slots.shape.reserve(shapes);
    root.slots.box.reserve(shapes);
    const auto add = [&](const auto& shape, std::uint32_t id) {
        if (!finite(shape)) return;
        root.slots.shape.push_back(id);
        root.slots.box.push_back(bounds_of(shape));
        bounds.extend(root.slots.box.back());
    };
    for (std::uint32_t i = 0; i < triangles; ++i) add(input.shapes.triangles[i], i);
    for (std::uint32_t i = triangles; i < shapes; ++i) add(input.shapes.spheres[i - triangles], i);
    root.node.shapes = static_cast<std::uint32_t>(root.slots.shape.size());
    if (root.node.shapes > 0) bounds = with_margin(bounds);
    root.node.cell = bounds;

    TaskErrors errors;
#pragma omp parallel for schedule(static, 1) if (root.node.shapes > task_shapes)
    for (int axis = 0; axis < 3; ++axis)
        errors.guard([&] {
            root.allocate(axis, 2 * std::size_t{root.node.shapes});
            Event* end = root.storage[axis].get();
            for (std::uint32_t slot = 0; slot < root.node.shapes; ++slot)
                for_each_event(slot, root.slots.box[slot], axis, [&](Event event) { *end++ = event; });
            root.node.events[axis] = {root.storage[axis].get(), end};
            const auto scratch = std::make_unique_for_overwrite<Event[]>(root.node.events[axis].size());
            sort_events(root.node.events[axis], {scratch.get(), root.node.events[axis].size()});
        });
    errors.rethrow();
    return root;
}

// Where a subtree's nodes, leaves and blocks go in the whole.
struct Placed {
    const Subtree* subtree;
    std::uint32_t root, nodes, leaves, triangle_blocks, sphere_blocks;
};

class Assembler {
  public:
    // Depth first: a split's children lie side by side, then what is below the lower, then what is below the upper.
    void place(const Branch& branch, std::uint32_t index) {
        counts += branch.counts;
        if (branch.subtree) {
            const Subtree& tree = *branch.subtree;
            placed.push_back({&tree, index, next_.nodes, next_.leaves, next_.triangle_blocks, next_.sphere_blocks});
            next_.nodes += static_cast<std::uint32_t>(tree.nodes.size()) - 1;
            next_.leaves += static_cast<std::uint32_t>(tree.leaves.size());
            next_.triangle_blocks += tree.triangle_blocks;
            next_.sphere_blocks += tree.sphere_blocks;
            counts += tree.counts;
            return;
        }
        const std::uint32_t first_child = next_.nodes;
        inner.push_back(
            {index, {branch.split.position, first_child << 2 | static_cast<std::uint32_t>(branch.split.axis)}});
        next_.nodes += 2;
        place(*branch.child[0], first_child);
        place(*branch.child[1], first_child + 1);
    }

    void fill(const Input& input, Hierarchy& hierarchy, KdTree& tree) const {
        tree.nodes.resize(next_.nodes);
        tree.leaves.resize(next_.leaves);
        hierarchy.triangle_blocks.resize(next_.triangle_blocks);
        hierarchy.sphere_blocks.resize(next_.sphere_blocks);
        for (const auto& [index, node] : inner) tree.nodes[index] = node;
#pragma omp parallel for schedule(dynamic, 1) if (placed.size() > 1)
        for (std::size_t i = 0; i < placed.size(); ++i) copy(placed[i], input, hierarchy, tree);
    }

    std::vector<Placed> placed;
    std::vector<std::pair<std::uint32_t, KdNode>> inner;
    Counts counts;

  private:
    static void copy(const Placed& to, const Input& input, Hierarchy& hierarchy, KdTree& tree) {
        const Subtree& from = *to.subtree;
        for (std::size_t i = 0; i < from.nodes.size(); ++i) {
            KdNode node = from.nodes[i];
            // Local node i > 0 goes to to.nodes + i - 1: the root has its place beside its sibling.
            node.data += (node.leaf() ? to.leaves : to.nodes - 1) << 2;
            tree.nodes[i == 0 ? to.root : to.nodes + i - 1] = node;
        }
        for (std::size_t i = 0; i < from.leaves.size(); ++i) {
            KdLeaf leaf = from.leaves[i];
            leaf.first_triangle_block += to.triangle_blocks;
            leaf.first_sphere_block += to.sphere_blocks;
            tree.leaves[to.leaves + i] = leaf;
            const auto ids =
                std::span(from.shapes).subspan(from.leaf_start[i], from.leaf_start[i + 1] - from.leaf_start[i]);
            const auto first_sphere =
                std::partition_point(ids.begin(), ids.end(), [&](std::uint32_t id) { return input.is_triangle(id); });
            fill_blocks(hierarchy.triangle_blocks.data() + leaf.first_triangle_block, {ids.begin(), first_sphere},
                        input.shapes.triangles);
            fill_blocks(hierarchy.sphere_blocks.data() + leaf.first_sphere_block, {first_sphere, ids.end()},
                        input.shapes.spheres, static_cast<std::uint32_t>(input.shapes.triangles.size()));
        }
    }

    Placed next_{nullptr, 0, 1, 0, 0, 0};  // the next free places; node 0 is the root's
};

int depth_limit_of(const KdOptions& options, std::size_t shapes) {
    if (options.depth_limit > 0) return std::min(options.depth_limit, KdTree::max_depth);
    return std::min(static_cast<int>(8 + 1.6 * std::log2(static_cast<double>(std::max<std::size_t>(shapes, 1)))),
                    KdTree::max_depth);
}

// Eight references a shape leave room for every sensible tree; the constant is for small scenes.
std::uint64_t reference_budget(std::uint64_t shapes) { return 8 * shapes + (1u << 17); }

}  // namespace
}  // namespace kd

Hierarchy build_kd_tree(const Shapes& shapes, const KdOptions& options, BuildStatistics* statistics) {
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t count = shapes.triangles.size() + shapes.spheres.size();
    if (count > (std::size_t{1} << 27)) throw std::length_error("more than 134 million shapes do not fit a kd-tree");
    const kd::Input input{shapes, options, kd::depth_limit_of(options, count)};
    Hierarchy hierarchy;
    kd::OwnedNode root = kd::root_of(input, hierarchy.bounds);
    root.node.budget = kd::reference_budget(root.node.shapes);
    std::uint64_t events = 0;
    for (const auto& list : root.node.events) events += 2 * list.size();  // created and sorted

    const kd::Branch top = kd::Builder(input).build(root);
    kd::Assembler assembler;
    assembler.place(top, 0);
    KdTree tree;
    assembler.fill(input, hierarchy, tree);
    tree.depth = assembler.counts.depth;

    if (statistics != nullptr) {
        const kd::Counts& counts = assembler.counts;
        statistics->events = events + counts.events;
        statistics->inner_nodes = counts.inner_nodes;
        statistics->leaves = counts.leaves;
        statistics->empty_leaves = counts.empty_leaves;
        statistics->references = counts.references;
        statistics->depth = counts.depth;
        statistics->sah_cost = hierarchy.bounds.empty() ? 0 : counts.cost / half_area(hierarchy.bounds);
        statistics->bytes = tree.nodes.size() * sizeof(KdNode) + tree.leaves.size() * sizeof(KdLeaf) +
                            hierarchy.triangle_blocks.size() * sizeof(TriangleBlock) +
                            hierarchy.sphere_blocks.size() * sizeof(SphereBlock);
    }
    hierarchy.tree = std::move(tree);
    if (statistics != nullptr)
        statistics->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return hierarchy;
}

}  // namespace raywalk
