#include "tracer/compiled/kdtree/node.h"

#include <algorithm>
#include <bit>

namespace raywalk::kd {

void NewEvents::clear() {
    for (auto& side : lists_)
        for (auto& list : side) list.clear();
    operations_ = 0;
}

void NewEvents::add(int side, std::uint32_t slot, const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        for_each_event(slot, box, axis, [&](Event event) { lists_[side][axis].push_back(event); });
}

void NewEvents::sort() {
    for (auto& side : lists_)
        for (auto& list : side) {
            scratch_.resize(list.size());
            sort_events(list, scratch_);
            operations_ += list.size() * std::bit_width(list.size());
            list.push_back(last_event);
        }
}

Split cheapest(const std::array<Split, 3>& splits) {
    return *std::min_element(splits.begin(), splits.end(),
                             [](const Split& a, const Split& b) { return a.cost < b.cost; });
}

std::array<Node, 2> children_of(const Node& node, const Split& split, std::uint32_t lower_shapes,
                                std::uint32_t upper_shapes) {
    std::array<Node, 2> child;
    for (Node& c : child) {
        c.cell = node.cell;
        c.depth = node.depth + 1;
    }
    child[0].cell.upper[split.axis] = child[1].cell.lower[split.axis] = split.position;
    child[0].shapes = lower_shapes;
    child[1].shapes = upper_shapes;
    // The spare references go to the children like the shapes themselves.
    const std::uint64_t sum = std::uint64_t{lower_shapes} + upper_shapes;
    const std::uint64_t spare = node.budget - sum;
    const auto share = sum == 0 ? 0 : static_cast<std::uint64_t>(double(spare) * lower_shapes / double(sum));
    child[0].budget = lower_shapes + share;
    child[1].budget = upper_shapes + spare - share;
    return child;
}

}  // namespace raywalk::kd
