// One node of the kd-tree: finding its plane by sweeping the sorted events, and splitting the events so that both
// halves stay sorted (Wald and Havran 2006, section 4.3).
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "tracer/compiled/hierarchy.h"
#include "tracer/compiled/kdtree/event.h"

namespace raywalk::kd {

// A plane and the expected cost of the node split there. Events [0, first_upper) of its axis lie below.
struct Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 3;
    float position = 0;
    std::uint32_t first_upper = 0;
};

// The cheapest plane strictly inside the cell, among the events of one axis of `shapes` shapes.
Split sweep(std::span<const Event> events, int axis, std::uint32_t shapes, const Bounds& cell,
            const KdOptions& options);

// Where a slot goes: its side in bits 30-31 and its slot there in the bits below. A straddler goes nowhere: it comes
// back as new events.
enum Side : std::uint32_t { straddles = 0, to_lower = 1u << 30, to_upper = 2u << 30 };

// Copies the events of one axis to the side where their slot goes, renamed, merging in the new events of that side.
// `new_lower` and `new_upper` are sorted and end with last_event. Both outputs have one event of room to spare;
// returns how many of each were written.
struct Distributed {
    std::uint32_t lower, upper;
};
Distributed distribute(std::span<const Event> events, const std::uint32_t* target, const Event* new_lower,
                       const Event* new_upper, Event* lower, Event* upper);

}  // namespace raywalk::kd
