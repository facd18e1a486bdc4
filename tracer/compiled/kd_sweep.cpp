#include "tracer/compiled/kd_sweep.h"

namespace raywalk::kd {

namespace {

// SAH of one cell cut along one axis.
class CostModel {
  public:
    CostModel(const Bounds& cell, int axis, const KdOptions& options)
        : lower_(cell.lower[axis]), upper_(cell.upper[axis]), options_(options) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double size = upper_ - lower_, width = double{cell.upper[u]} - cell.lower[u],
                     height = double{cell.upper[v]} - cell.lower[v];
        const double area = size * (width + height) + width * height;
        ends_ = options.intersection_cost * width * height / area;
        per_length_ = options.intersection_cost * (width + height) / area;
    }
    [[nodiscard]] bool inside(double position) const { return position > lower_ && position < upper_; }
    [[nodiscard]] double cost(double position, std::uint32_t below, std::uint32_t above) const {
        return options_.traversal_cost + (ends_ + (position - lower_) * per_length_) * leaf_cost(below) +
               (ends_ + (upper_ - position) * per_length_) * leaf_cost(above);
    }
    // The same where one side may be empty.
    [[nodiscard]] double cost_with_bonus(double position, std::uint32_t below, std::uint32_t above) const {
        return (below == 0 || above == 0 ? options_.empty_factor : 1.0f) * cost(position, below, above);
    }

  private:
    double lower_, upper_, ends_, per_length_;
    const KdOptions& options_;
};

}  // namespace

Split sweep(std::span<const Event> events, int axis, std::uint32_t shapes, const Bounds& cell,
            const KdOptions& options) {
    const CostModel model(cell, axis, options);
    Split best;
    best.axis = axis;
    const auto consider = [&](double cost, float position, std::size_t first_upper) {
        if (cost < best.cost && model.inside(position)) {
            best.cost = cost;
            best.position = position;
            best.first_upper = static_cast<std::uint32_t>(first_upper);
        }
    };
    const std::size_t count = events.size();
    if (count == 0) return best;

    // Cutting off the empty space before the first and behind the last shape.
    const float first = position_of(events.front()), last = position_of(events.back());
    consider(model.cost_with_bonus(first, 0, shapes), first, 0);
    consider(model.cost_with_bonus(last, shapes, 0), last, count);

    // Every event offers a plane. Of the events at one position the last end and the first start see the right counts;
    // the others see too many shapes and lose to them, so runs of equal positions need no loop of their own.
    std::uint32_t below = 0, above = shapes;
    for (std::size_t i = 0; i < count; ++i) {
        const Event event = events[i];
        const EventType type = type_of(event);
        const float position = position_of(event);
        if (type == EventType::planar) [[unlikely]] {
            // Flat shapes on the plane: all above it, or all below it.
            consider(model.cost_with_bonus(position, below, above), position, i);
            std::size_t end = i + 1;
            while (end < count && events[end] >> 30 == event >> 30) ++end;
            const auto flat = static_cast<std::uint32_t>(end - i);
            below += flat;
            above -= flat;
            consider(model.cost_with_bonus(position, below, above), position, end);
            i = end - 1;
            continue;
        }
        const std::uint32_t start = static_cast<std::uint32_t>(type) >> 1;
        above -= 1 - start;
        consider(model.cost(position, below, above), position, i + 1 - start);
        below += start;
    }
    return best;
}

Distributed distribute(std::span<const Event> events, const std::uint32_t* target, const Event* new_lower,
                       const Event* new_upper, Event* lower, Event* upper) {
    constexpr Event kept_bits = ~Event{slot_mask};
    Event* const lower_begin = lower;
    Event* const upper_begin = upper;
    for (const Event event : events) {
        const std::uint32_t to = target[slot_of(event)];
        const Event renamed = (event & kept_bits) | (to & slot_mask);
        while (*new_lower < renamed) *lower++ = *new_lower++;
        *lower = renamed;
        lower += (to >> 30) & 1;
        while (*new_upper < renamed) *upper++ = *new_upper++;
        *upper = renamed;
        upper += to >> 31;
    }
    while (*new_lower != last_event) *lower++ = *new_lower++;
    while (*new_upper != last_event) *upper++ = *new_upper++;
    return {static_cast<std::uint32_t>(lower - lower_begin), static_cast<std::uint32_t>(upper - upper_begin)};
}

}  // namespace raywalk::kd
