// Rays per second by kind: both hierarchies against the best call that Embree has for the kind.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/agreement.h"
#include "tests/bench/measure.h"
#include "tests/bench/ray_sets.h"
#include "tracer/compiled/hierarchy.h"

namespace raywalk::bench {

inline constexpr Accelerator accelerators[] = {Accelerator::kdtree, Accelerator::bvh};
std::string_view name_of(Accelerator accelerator);

// A scene that the kernels' ray doors can trace: shapes and hierarchy, no surfaces.
CompiledScene compiled_shapes(const Geometry& geometry, Accelerator accelerator, BuildStatistics* statistics = nullptr);

struct RateRow {
    std::string workload;
    RayKind kind{};
    std::size_t rays = 0;
    std::string best_embree;              // which call, build and spheres
    double embree_rate = 0;               // rays per second of one thread
    std::array<double, 2> rate{};         // by accelerator
    std::array<Spread, 2> ratio{};        // Embree's time / ours
    std::map<std::string, double> calls;  // rays per second of every Embree call, from the short first comparison
    std::array<Agreement, 2> agreement{};

    [[nodiscard]] double best_ratio() const { return std::max(ratio[0].median, ratio[1].median); }
};

struct RateOptions {
    Picture picture;
    int rounds = 9;
    const Kernels* kernels = nullptr;
};

// Traces rays of one kind over and over, for a profiler to look at; returns rays per second.
double trace_for(double seconds, RayKind kind, Accelerator accelerator, const Geometry& geometry,
                 const RateOptions& options);

std::vector<RateRow> measure_rates(const Geometry& geometry, const RateOptions& options);

}  // namespace raywalk::bench
