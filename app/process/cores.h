// How many cores this process may use.
#pragma once

#include <string_view>

namespace raywalk {

inline constexpr int most_threads = 1024;  // that may be asked for

// What OpenMP would use (processor affinity and OMP_NUM_THREADS honoured), at most the control group's share of time.
int usable_cores();

// The cores' worth of time in a cgroup v2 "cpu.max" ("200000 100000" is 2), rounded up; 0 where there is no limit.
int cores_of_quota(std::string_view cpu_max);

}  // namespace raywalk
