// Time and memory of building the hierarchies, against Embree's three qualities.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/bench/geometry.h"
#include "tests/bench/measure.h"

namespace raywalk::bench {

struct BuildRow {
    struct Contender {
        std::string name;
        Spread one_thread, all_threads;  // seconds
        double bytes = 0;                // per shape
    };
    std::string workload;
    std::size_t shapes = 0;
    std::vector<Contender> contenders;  // kd-tree, BVH, Embree LOW, MEDIUM, HIGH
    double bvh_to_medium = 0;           // one thread, ratio of times, medians of rounds
    double kd_to_high = 0;
    int threads = 1;
};
BuildRow measure_builds(const Geometry& geometry, int rounds);

}  // namespace raywalk::bench
