#include "tests/bench/builds.h"

#include <omp.h>

#include "tests/bench/embree_scene.h"
#include "tracer/compiled/hierarchy.h"

namespace raywalk::bench {

namespace {

constexpr RTCBuildQuality qualities[] = {RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH};

// Every contender's build as a pass; what it builds goes when the time has been taken. bytes[i]: of what was built.
std::vector<Pass> build_passes(const Geometry& geometry, const Shapes& shapes, const EmbreeDevice& device, Clock clock,
                               std::array<double, 5>& bytes) {
    std::vector<Pass> passes;
    for (std::size_t a = 0; a < 2; ++a) {
        passes.emplace_back([&, a, clock] {
            BuildStatistics statistics;
            const double start = seconds(clock);
            const Hierarchy hierarchy =
                a == 0 ? build_kd_tree(shapes, KdOptions{}, &statistics) : build_bvh(shapes, &statistics);
            const double time = seconds(clock) - start;
            bytes[a] = static_cast<double>(statistics.bytes);
            return time;
        });
    }
    for (std::size_t q = 0; q < std::size(qualities); ++q) {
        passes.emplace_back([&, q, clock] {
            const EmbreeScene scene(device, geometry, {qualities[q], EmbreeSpheres::callback}, clock);
            bytes[2 + q] = static_cast<double>(scene.bytes());
            return scene.build_seconds();
        });
    }
    return passes;
}

}  // namespace

BuildRow measure_builds(const Geometry& geometry, int rounds) {
    const std::vector<TriangleCorners> corners = geometry.corners();
    const Shapes shapes{corners, geometry.spheres};
    BuildRow row;
    row.workload = geometry.name;
    row.shapes = corners.size() + geometry.spheres.size();
    row.threads = omp_get_max_threads();
    for (const char* name : {"kd-tree", "BVH", "Embree LOW", "Embree MEDIUM", "Embree HIGH"})
        row.contenders.push_back({.name = name, .one_thread = {}, .all_threads = {}});

    std::array<double, 5> bytes{};
    for (const bool alone : {true, false}) {
        const int threads = alone ? 1 : row.threads;
        const EmbreeDevice device(threads);
        omp_set_num_threads(threads);
        const auto times =
            take_turns(build_passes(geometry, shapes, device, alone ? Clock::process_cpu : Clock::wall, bytes), rounds);
        omp_set_num_threads(row.threads);
        for (std::size_t i = 0; i < times.size(); ++i)
            (alone ? row.contenders[i].one_thread : row.contenders[i].all_threads) = spread_of(times[i]);
        if (!alone) continue;
        row.kd_to_high = ratio_of(times[0], times[4]).median;
        row.bvh_to_medium = ratio_of(times[1], times[3]).median;
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) row.contenders[i].bytes = bytes[i] / static_cast<double>(row.shapes);
    return row;
}

}  // namespace raywalk::bench
