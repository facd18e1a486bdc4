#include "tracer/ground/memory_left.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "tracer/ground/control_groups.h"

namespace raywalk {

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t available_of_machine() {
    std::ifstream lines("/proc/meminfo");
    for (std::string word; lines >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == "MemAvailable:" && lines >> kilobytes) return kilobytes << 10;
    }
    return unlimited;
}

std::uint64_t left_of_address_space() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    std::ifstream statistics("/proc/self/statm");
    std::uint64_t pages = 0;
    statistics >> pages;
    const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

}  // namespace

std::uint64_t memory_left() {
    return std::min(
        {available_of_machine(), left_of_address_space(), ControlGroups().memory_left().value_or(unlimited)});
}

}  // namespace raywalk
