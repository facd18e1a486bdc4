#include "app/process/stacks.h"

#include <sys/resource.h>

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tracer/ground/error.h"

namespace raywalk {

namespace {

constexpr unsigned long long least_stack = 1 << 20;  // bytes; a tile and a build of a tree take a fraction of it

// OpenMP's way to write a size: a number of kilobytes, or followed by B, K, M or G. What is no size counts as enough:
// OpenMP passes over it.
bool is_too_small(std::string_view size) {
    while (!size.empty() && std::isspace(static_cast<unsigned char>(size.front()))) size.remove_prefix(1);
    unsigned long long number = 0;
    const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), number);
    if (error != std::errc()) return false;
    std::string_view unit = size.substr(static_cast<std::size_t>(end - size.data()));
    while (!unit.empty() && std::isspace(static_cast<unsigned char>(unit.front()))) unit.remove_prefix(1);
    switch (unit.empty() ? 'k' : std::tolower(static_cast<unsigned char>(unit.front()))) {
        case 'b':
            return number < least_stack;
        case 'k':
            return number < least_stack >> 10;
        default:
            return number < least_stack >> 20;
    }
}

}  // namespace

bool make_room_for_stacks() {
    bool changed = false;
    rlimit limit = {};
    if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < least_stack) {
        if (limit.rlim_max < least_stack)
            throw WorkError("the stack is limited to " + std::to_string(limit.rlim_max >> 10) +
                            " KB, and 1024 KB are needed: ulimit -s 1024 before the program is started");
        limit.rlim_cur = least_stack;
        changed = setrlimit(RLIMIT_STACK, &limit) == 0;
    }
    for (const char* name : {"OMP_STACKSIZE", "GOMP_STACKSIZE"}) {
        const char* value = std::getenv(name);
        if (value != nullptr && is_too_small(value)) changed |= unsetenv(name) == 0;
    }
    return changed;
}

}  // namespace raywalk
