// How much memory this process may still take.
#pragma once

#include <cstdint>

namespace raywalk {

// Bytes: the least of what the machine has available, what control groups leave, and what `ulimit -v` leaves. The
// largest number where nothing says.
std::uint64_t memory_left();

}  // namespace raywalk
