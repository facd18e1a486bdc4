// How time and memory grow with triangles, lights, pixels and threads.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/frames.h"

namespace raywalk::bench {

struct TriangleGrowth {
    double triangles = 0;
    std::array<double, 2> build_seconds{};  // CPU seconds, by accelerator
    std::array<double, 2> build_wall{};     // by all threads
    std::array<double, 2> bytes{};          // of the hierarchy
    std::array<double, 2> primary{};        // nanoseconds a ray, one thread
    std::array<double, 2> diffuse{};
    std::array<double, 2> build_work{};  // event operations or primitives binned
};
TriangleGrowth measure_triangles(std::size_t triangles, const Kernels& kernels);

// Milliseconds a frame against a count: of light points, of pixels, of threads.
struct FrameGrowth {
    std::string label;
    double count = 0;
    double milliseconds = 0;
    double sampled_milliseconds = 0;  // lights: one sample of a walk, which takes a few points of each light
};
std::vector<FrameGrowth> measure_lights(const FrameScene& frame, const std::vector<int>& sides, const Kernels& kernels);
std::vector<FrameGrowth> measure_sizes(const FrameScene& frame, const Kernels& kernels);
std::vector<FrameGrowth> measure_threads(const FrameScene& frame, const Kernels& kernels);

}  // namespace raywalk::bench
