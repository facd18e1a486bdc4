// How many cores this process may use.
#pragma once

namespace raywalk {

inline constexpr int most_threads = 1024;  // that may be asked for

// What OpenMP would use (processor affinity and OMP_NUM_THREADS honoured), at most the control groups' share of time.
int usable_cores();

}  // namespace raywalk
