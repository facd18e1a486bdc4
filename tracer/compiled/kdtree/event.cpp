#include "tracer/compiled/kdtree/event.h"

#include <algorithm>
#include <array>
#include <utility>

namespace raywalk::kd {

namespace {

constexpr std::size_t radix_worthwhile = 4096;  // below, comparing is faster than clearing three histograms

// Bits 30-63 are the key, sorted from the lowest digit up.
constexpr int digit_count = 3;
constexpr std::array<int, digit_count> digit_shift{30, 42, 53};
constexpr std::array<int, digit_count> digit_bits{12, 11, 11};

std::size_t digit(Event event, int d) { return (event >> digit_shift[d]) & ((1u << digit_bits[d]) - 1); }

}  // namespace

void sort_events(std::span<Event> events, std::span<Event> scratch) {
    if (events.size() < radix_worthwhile) {
        std::sort(events.begin(), events.end());
        return;
    }
    std::array<std::array<std::uint32_t, 4096>, digit_count> offsets{};
    for (const Event event : events)
        for (int d = 0; d < digit_count; ++d) ++offsets[d][digit(event, d)];
    Event* from = events.data();
    Event* to = scratch.data();
    for (int d = 0; d < digit_count; ++d) {
        std::uint32_t sum = 0;
        for (std::uint32_t& offset : offsets[d]) sum += std::exchange(offset, sum);
        for (std::size_t i = 0; i < events.size(); ++i) to[offsets[d][digit(from[i], d)]++] = from[i];
        std::swap(from, to);
    }
    if (from != events.data()) std::copy(from, from + events.size(), events.data());
}

}  // namespace raywalk::kd
