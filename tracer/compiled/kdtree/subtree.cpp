#include "tracer/compiled/kdtree/subtree.h"

#include <algorithm>

#include "tracer/compiled/shape_bounds.h"

namespace raywalk::kd {

Counts& Counts::operator+=(const Counts& other) {
    events += other.events;
    inner_nodes += other.inner_nodes;
    leaves += other.leaves;
    empty_leaves += other.empty_leaves;
    references += other.references;
    depth = std::max(depth, other.depth);
    cost += other.cost;
    return *this;
}

Event* EventArena::allocate(std::size_t count) {
    while (at_.chunk < chunks_.size() && chunks_[at_.chunk].size - at_.used < count) at_ = {at_.chunk + 1, 0};
    if (at_.chunk == chunks_.size()) {
        constexpr std::size_t chunk_size = std::size_t{1} << 16;
        const std::size_t size = std::max(count, chunk_size);
        chunks_.push_back({std::make_unique_for_overwrite<Event[]>(size), size});
    }
    Event* const result = chunks_[at_.chunk].events.get() + at_.used;
    at_.used += count;
    return result;
}

namespace {

// Orders slots so that each block of sixteen holds neighbours: a beam passes by most blocks of a leaf at one test each.
void gather_neighbours(std::span<std::uint32_t> slots, const std::vector<Bounds>& box) {
    while (slots.size() > lanes) {
        Bounds centers;
        const auto center = [&](std::uint32_t slot) { return box[slot].lower * 0.5f + box[slot].upper * 0.5f; };
        for (const std::uint32_t slot : slots) centers.extend(center(slot));
        const glm::vec3 size = centers.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t half = (slots.size() / lanes + 1) / 2 * lanes;
        std::nth_element(slots.begin(), slots.begin() + static_cast<std::ptrdiff_t>(half), slots.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return center(a)[axis] < center(b)[axis]; });
        gather_neighbours(slots.subspan(half), box);
        slots = slots.first(half);
    }
}

}  // namespace

void Subtree::add_leaf(std::uint32_t node, const Node& of, const Slots& slots, const Input& input) {
    const std::size_t start = shapes.size();
    for (const Event event : of.events[0])
        if (type_of(event) != EventType::end) shapes.push_back(slot_of(event));
    const auto is_triangle = [&](std::uint32_t slot) { return input.is_triangle(slots.shape[slot]); };
    const auto first_sphere =
        std::stable_partition(shapes.begin() + static_cast<std::ptrdiff_t>(start), shapes.end(), is_triangle);
    const auto spheres = static_cast<std::uint32_t>(shapes.end() - first_sphere);
    const auto triangles = static_cast<std::uint32_t>(shapes.size() - start) - spheres;
    const auto of_leaf = std::span(shapes).subspan(start);
    gather_neighbours(of_leaf.first(triangles), slots.box);
    gather_neighbours(of_leaf.last(spheres), slots.box);
    for (std::uint32_t& shape : of_leaf) shape = slots.shape[shape];
    leaves.push_back({triangle_blocks, sphere_blocks, blocks_for(triangles), blocks_for(spheres)});
    leaf_start.push_back(static_cast<std::uint32_t>(shapes.size()));
    triangle_blocks += blocks_for(triangles);
    sphere_blocks += blocks_for(spheres);
    nodes[node] = {0, static_cast<std::uint32_t>(leaves.size() - 1) << 2 | 3};

    counts.leaves += 1;
    counts.empty_leaves += triangles + spheres == 0;
    counts.references += triangles + spheres;
    counts.depth = std::max(counts.depth, of.depth);
    counts.cost += half_area(of.cell) * input.options.intersection_cost * (blocks_for(triangles) + blocks_for(spheres));
}

Subtree SubtreeBuilder::build(const Input& input, Slots& slots, const Node& root) {
    input_ = &input;
    slots_ = &slots;
    tree_ = {};
    tree_.nodes.emplace_back();
    arena_.release({});
    split(0, root);
    return std::move(tree_);
}

void SubtreeBuilder::classify(const Node& node, const Split& split, std::array<std::uint32_t, 2>& sizes) {
    target_.resize(slots_->shape.size());
    straddlers_.clear();
    const auto events = node.axis(split.axis);
    std::uint32_t lower = 0, upper = 0;
    for (std::uint32_t i = 0; i < split.first_upper; ++i) {
        const std::uint32_t slot = slot_of(events[i]);
        const bool starts = type_of(events[i]) == EventType::start;
        target_[slot] = starts ? straddles : to_lower | slot;  // until its end is seen
        lower += !starts;
    }
    for (std::size_t i = split.first_upper; i < events.size(); ++i) {
        const std::uint32_t slot = slot_of(events[i]);
        if (type_of(events[i]) != EventType::end) {
            target_[slot] = to_upper | slot;
            ++upper;
        } else if (target_[slot] == straddles) {
            straddlers_.push_back(slot);
        }
    }
    new_events_.clear();
    for (const std::uint32_t slot : straddlers_) {
        const Parts parts = input_->split(slots_->shape[slot], slots_->box[slot], split.axis, split.position);
        std::uint32_t upper_slot = slot;
        if (!parts.lower.empty()) {
            slots_->box[slot] = parts.lower;
            new_events_.add(0, slot, parts.lower);
            ++lower;
            if (parts.upper.empty()) continue;
            upper_slot = static_cast<std::uint32_t>(slots_->shape.size());
            slots_->shape.push_back(slots_->shape[slot]);
            slots_->box.emplace_back();
        }
        if (!parts.upper.empty()) {
            slots_->box[upper_slot] = parts.upper;
            new_events_.add(1, upper_slot, parts.upper);
            ++upper;
        }
    }
    new_events_.sort();
    sizes = {lower, upper};
}

void SubtreeBuilder::split(std::uint32_t index, const Node& node) {
    const KdOptions& options = input_->options;
    if (node.shapes <= static_cast<std::uint32_t>(options.leaf_limit) || node.depth >= input_->depth_limit)
        return tree_.add_leaf(index, node, *slots_, *input_);

    std::array<Split, 3> splits;
    for (int axis = 0; axis < 3; ++axis) {
        splits[axis] = sweep(node.axis(axis), axis, node.shapes, node.cell, options);
        tree_.counts.events += node.events[axis].size();
    }
    const Split best = cheapest(splits);
    if (best.cost >= options.intersection_cost * leaf_cost(node.shapes))
        return tree_.add_leaf(index, node, *slots_, *input_);

    const std::size_t slot_count = slots_->shape.size();
    std::array<std::uint32_t, 2> sizes;
    classify(node, best, sizes);
    if (std::uint64_t{sizes[0]} + sizes[1] > node.budget) return tree_.add_leaf(index, node, *slots_, *input_);

    const EventArena::Mark mark = arena_.mark();
    std::array<Node, 2> child = children_of(node, best, sizes[0], sizes[1]);
    for (int axis = 0; axis < 3; ++axis) {
        Event* const lower = arena_.allocate(2 * std::size_t{sizes[0]} + 1);
        Event* const upper = arena_.allocate(2 * std::size_t{sizes[1]} + 1);
        const Distributed written = distribute(node.axis(axis), target_.data(), new_events_.of(0, axis).data(),
                                               new_events_.of(1, axis).data(), lower, upper);
        child[0].events[axis] = {lower, written.lower};
        child[1].events[axis] = {upper, written.upper};
        tree_.counts.events += node.events[axis].size();
    }
    tree_.counts.events += new_events_.operations();

    tree_.counts.inner_nodes += 1;
    tree_.counts.cost += half_area(node.cell) * options.traversal_cost;
    const auto first_child = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes[index] = {best.position, first_child << 2 | static_cast<std::uint32_t>(best.axis)};
    tree_.nodes.resize(tree_.nodes.size() + 2);
    split(first_child, child[0]);
    split(first_child + 1, child[1]);
    arena_.release(mark);
    slots_->shape.resize(slot_count);
    slots_->box.resize(slot_count);
}

}  // namespace raywalk::kd
