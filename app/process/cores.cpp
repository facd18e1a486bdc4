#include "app/process/cores.h"

#include <omp.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string>

namespace raywalk {

int cores_of_quota(std::string_view cpu_max) {
    const auto number_at = [&](std::size_t at) {
        long long value = 0;
        if (at < cpu_max.size()) std::from_chars(cpu_max.data() + at, cpu_max.data() + cpu_max.size(), value);
        return value;
    };
    const std::size_t blank = cpu_max.find(' ');
    if (blank == std::string_view::npos) return 0;
    const long long quota = number_at(0), period = number_at(blank + 1);
    if (quota <= 0 || period <= 0) return 0;  // "max 100000"
    return static_cast<int>(std::clamp((quota + period - 1) / period, 1LL, static_cast<long long>(most_threads)));
}

int usable_cores() {
    const int cores = std::clamp(omp_get_max_threads(), 1, most_threads);  // OMP_NUM_THREADS can say anything
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string text;
    std::getline(file, text);
    const int quota = cores_of_quota(text);
    return quota == 0 ? cores : std::min(cores, quota);
}

}  // namespace raywalk
