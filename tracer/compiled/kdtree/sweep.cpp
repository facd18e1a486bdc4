#include "tracer/compiled/kdtree/sweep.h"

#include <algorithm>
#include <array>

namespace raywalk::kd {

namespace {

constexpr std::size_t worth_bounding = 160;  // events; shorter lists are swept whole
constexpr std::size_t shortest_stretch = 16, most_stretches = 256;

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
    // Of any plane between two positions with at least so many shapes on either side, empty sides included.
    [[nodiscard]] double lower_bound(double first, std::uint32_t below, double last, std::uint32_t above) const {
        const double cost = options_.traversal_cost + (ends_ + (first - lower_) * per_length_) * leaf_cost(below) +
                            (ends_ + (upper_ - last) * per_length_) * leaf_cost(above);
        return below == 0 || above == 0 ? options_.empty_factor * cost : cost;
    }
    // The same where one side may be empty.
    [[nodiscard]] double cost_with_bonus(double position, std::uint32_t below, std::uint32_t above) const {
        return (below == 0 || above == 0 ? options_.empty_factor : 1.0f) * cost(position, below, above);
    }

  private:
    double lower_, upper_, ends_, per_length_;
    const KdOptions& options_;
};

// Sweeps the events [begin, end), before which `below` shapes begin and behind or in which `above` end.
class Sweep {
  public:
    Sweep(std::span<const Event> events, const CostModel& model) : events_(events), model_(model) {}

    void consider(double cost, float position, std::size_t first_upper) {
        if (cost < best.cost && model_.inside(position)) {
            best.cost = cost;
            best.position = position;
            best.first_upper = static_cast<std::uint32_t>(first_upper);
        }
    }

    // Every event offers a plane. Of the events at one position the last end and the first start see the right counts;
    // the others see too many shapes and lose to them, so runs of equal positions need no loop of their own.
    void over(std::size_t begin, std::size_t end, std::uint32_t below, std::uint32_t above) {
        for (std::size_t i = begin; i < end; ++i) {
            const Event event = events_[i];
            const EventType type = type_of(event);
            const float position = position_of(event);
            if (type == EventType::planar) [[unlikely]] {
                // Flat shapes on the plane: all above it, or all below it.
                consider(model_.cost_with_bonus(position, below, above), position, i);
                std::size_t next = i + 1;
                while (next < events_.size() && events_[next] >> 30 == event >> 30) ++next;
                const auto flat = static_cast<std::uint32_t>(next - i);
                below += flat;
                above -= flat;
                consider(model_.cost_with_bonus(position, below, above), position, next);
                i = next - 1;
                continue;
            }
            const std::uint32_t start = static_cast<std::uint32_t>(type) >> 1;
            above -= 1 - start;
            consider(model_.cost(position, below, above), position, i + 1 - start);
            below += start;
        }
    }

    Split best;

  private:
    std::span<const Event> events_;
    const CostModel& model_;
};

// Events before which `below` shapes begin or lie flat, and `above` have not ended.
struct Stretch {
    std::uint32_t begin, below, above;
};

}  // namespace

Split sweep(std::span<const Event> events, int axis, std::uint32_t shapes, const Bounds& cell,
            const KdOptions& options) {
    const CostModel model(cell, axis, options);
    Sweep sweep(events, model);
    sweep.best.axis = axis;
    const std::size_t count = events.size();
    if (count == 0) return sweep.best;

    // Cutting off the empty space before the first and behind the last shape.
    const float first = position_of(events.front()), last = position_of(events.back());
    sweep.consider(model.cost_with_bonus(first, 0, shapes), first, 0);
    sweep.consider(model.cost_with_bonus(last, shapes, 0), last, count);
    if (count < worth_bounding) {
        sweep.over(0, count, 0, shapes);
        return sweep.best;
    }

    // Few stretches of a long list can hold the cheapest plane: below a plane of a stretch there is at least what is
    // below its first event, above it at least what is above its last. The bound is compared with the cost of the
    // planes between stretches.
    const std::size_t length = std::max(shortest_stretch, count / most_stretches + 1);
    std::array<Stretch, most_stretches + 1> stretches;
    std::size_t stretch_count = 0;
    double cheapest_between = sweep.best.cost;
    std::uint32_t below = 0, above = shapes;
    std::size_t begin = 0;
    while (begin < count) {
        std::size_t next = std::min(begin + length, count);
        while (next < count && type_of(events[next]) == EventType::planar &&
               events[next] >> 30 == events[next - 1] >> 30)
            ++next;  // flat shapes on one plane stay together
        stretches[stretch_count++] = {static_cast<std::uint32_t>(begin), below, above};
        const float position = position_of(events[begin]);
        if (type_of(events[begin]) != EventType::planar && model.inside(position))
            cheapest_between = std::min(cheapest_between, model.cost(position, below, above));
        std::uint32_t starts = 0, flats = 0;
        for (std::size_t i = begin; i < next; ++i) {
            starts += static_cast<std::uint32_t>(events[i] >> 31) & 1;
            flats += static_cast<std::uint32_t>(events[i] >> 30) & 1;
        }
        below += starts + flats;
        above -= static_cast<std::uint32_t>(next - begin) - starts;
        begin = next;
    }
    stretches[stretch_count] = {static_cast<std::uint32_t>(count), below, above};
    for (std::size_t s = 0; s < stretch_count; ++s) {
        const Stretch &from = stretches[s], &to = stretches[s + 1];
        const double bound =
            model.lower_bound(position_of(events[from.begin]), from.below, position_of(events[to.begin - 1]), to.above);
        if (bound <= std::min(cheapest_between, sweep.best.cost))
            sweep.over(from.begin, to.begin, from.below, from.above);
    }
    return sweep.best;
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
