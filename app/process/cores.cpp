#include "app/process/cores.h"

#include <omp.h>

#include <algorithm>

#include "tracer/ground/control_groups.h"

namespace raywalk {

int usable_cores() {
    const int cores = std::clamp(omp_get_max_threads(), 1, most_threads);  // OMP_NUM_THREADS can say anything
    const int quota = ControlGroups().cores();
    return quota == 0 ? cores : std::min(cores, quota);
}

}  // namespace raywalk
