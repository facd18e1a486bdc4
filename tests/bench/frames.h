// Whole pictures: Raywalk against the same pictures on Embree, with plain shading and with Raywalk's own.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/geometry.h"
#include "tests/bench/measure.h"
#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/kernels.h"
#include "tracer/rendering/renderer.h"

namespace raywalk::bench {

struct FrameScene {
    std::string name;
    Scene scene;
};
FrameScene read_frame_scene(const std::filesystem::path& file);
// The mesh of an OBJ file over a chequered floor, two lights, perhaps the field of balls.
FrameScene mesh_scene(const std::filesystem::path& obj, std::string name, bool balls);

CompiledScene compile_for(const FrameScene& frame, Accelerator accelerator);
View view_of(const FrameScene& frame, int width, int height);
// One sample a pixel, again and again however often it is called.
void render_again(Renderer& renderer);

// Share of pixels that differ by more than 1/255 in display values.
inline constexpr double tolerated_pixels = 0.002;

struct FrameRow {
    std::string name;
    double scalar_on_embree = 0, simd_on_embree = 0;  // seconds of one thread
    std::array<double, 2> seconds{};                  // ours, by accelerator
    std::array<Spread, 2> against_scalar{}, against_simd{};
    Spread two_threads;      // one thread's time / that of two, by the wall clock; of the faster accelerator
    Spread two_threads_cpu;  // the same were nothing else running: by the mean of both threads' CPU time
    std::array<double, 2> different_pixels{};  // share, by accelerator, against the plain renderer on Embree
    [[nodiscard]] bool good() const {
        return different_pixels[0] <= tolerated_pixels && different_pixels[1] <= tolerated_pixels;
    }
};

struct FrameOptions {
    int width = 1280, height = 720, rounds = 5;
    const Kernels* kernels = nullptr;
};
FrameRow measure_frame(const FrameScene& frame, const FrameOptions& options);

}  // namespace raywalk::bench
