// Split events of the kd-tree builder: where a shape's box starts, ends, or lies flat along one axis. Wald and Havran,
// "On building fast kd-trees for ray tracing, and on doing that in O(N log N)", 2006, section 4.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace raywalk::kd {

// One 64-bit integer, so that sorting and merging are integer work: bits 32-63 the position in an encoding that orders
// like the number, bits 30-31 the type, bits 0-29 the slot (a shape, or the part of it that is in the cell).
// At one position ends come before flat shapes and flat shapes before starts.
using Event = std::uint64_t;

enum class EventType : std::uint32_t { end = 0, planar = 1, start = 2 };

inline constexpr std::uint32_t slot_mask = (1u << 30) - 1;
inline constexpr Event last_event = ~Event{0};  // greater than every event

inline std::uint32_t ordered_bits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits ^ (static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31) | 0x80000000u);
}

inline Event make_event(float position, EventType type, std::uint32_t slot) {
    return Event{ordered_bits(position)} << 32 | static_cast<std::uint32_t>(type) << 30 | slot;
}

inline std::uint32_t slot_of(Event event) { return static_cast<std::uint32_t>(event) & slot_mask; }
inline EventType type_of(Event event) { return static_cast<EventType>((event >> 30) & 3); }
inline float position_of(Event event) {
    const auto key = static_cast<std::uint32_t>(event >> 32);
    return std::bit_cast<float>(key ^
                                (~static_cast<std::uint32_t>(static_cast<std::int32_t>(key) >> 31) | 0x80000000u));
}

// Sorts by position and type. `scratch` is as long as `events`.
void sort_events(std::span<Event> events, std::span<Event> scratch);

}  // namespace raywalk::kd
