// What both halves of the kd-tree builder pass around: the parts of shapes in a cell, and a cell to be split.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tracer/compiled/kdtree/clip.h"
#include "tracer/compiled/kdtree/sweep.h"

namespace raywalk::kd {

// Shapes by one number: triangles first, then spheres.
struct Input {
    Shapes shapes;
    KdOptions options;
    int depth_limit;

    [[nodiscard]] bool is_triangle(std::uint32_t shape) const { return shape < shapes.triangles.size(); }
    [[nodiscard]] Parts split(std::uint32_t shape, const Bounds& box, int axis, float plane) const {
        return is_triangle(shape) ? split_triangle(shapes.triangles[shape], box, axis, plane)
                                  : split_sphere(shapes.spheres[shape - shapes.triangles.size()], box, axis, plane);
    }
};

// A slot is the part of one shape in one cell.
struct Slots {
    std::vector<std::uint32_t> shape;
    std::vector<Bounds> box;
};

// A cell to be split: the events of its slots along each axis, sorted.
struct Node {
    std::array<std::span<Event>, 3> events;
    std::uint32_t shapes = 0;
    Bounds cell;
    int depth = 0;
    // References that the leaves below may hold in all: splitting stops before shapes that all overlap each other fill
    // the memory. A node hands it on to its children in proportion to their shapes, so that threads do not matter.
    std::uint64_t budget = 0;

    [[nodiscard]] std::span<const Event> axis(int k) const { return events[k]; }
};

// Events of the parts of straddlers, for each side and axis: [side][axis].
class NewEvents {
  public:
    void clear();
    void add(int side, std::uint32_t slot, const Bounds& box);
    void sort();  // and end each list with last_event
    [[nodiscard]] const std::vector<Event>& of(int side, int axis) const { return lists_[side][axis]; }
    [[nodiscard]] std::uint64_t operations() const { return operations_; }  // created and sorted

  private:
    std::array<std::array<std::vector<Event>, 3>, 2> lists_;
    std::vector<Event> scratch_;
    std::uint64_t operations_ = 0;
};

// Calls visit for the one or two events of a box along an axis, in order.
template <class Visit>
void for_each_event(std::uint32_t slot, const Bounds& box, int axis, Visit visit) {
    if (box.lower[axis] == box.upper[axis]) {
        visit(make_event(box.lower[axis], EventType::planar, slot));
    } else {
        visit(make_event(box.lower[axis], EventType::start, slot));
        visit(make_event(box.upper[axis], EventType::end, slot));
    }
}

// The cheapest of the three axes' splits; the lower axis of equals.
Split cheapest(const std::array<Split, 3>& splits);

// The children's cells, depths and shares of the budget.
std::array<Node, 2> children_of(const Node& node, const Split& split, std::uint32_t lower_shapes,
                                std::uint32_t upper_shapes);

}  // namespace raywalk::kd
