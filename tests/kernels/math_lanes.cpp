#include "tests/kernels/math_lanes.h"

#include "tracer/kernels/lanes/math.h"
#include "tracer/kernels/lanes/random.h"
#include "tracer/kernels/shading/camera_rays.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

// Sixteen at a time; the arrays are whole sixteens.
void exp_of(const float* x, float* y, std::size_t n) {
    for (std::size_t i = 0; i < n; i += lanes) store(exp(load(x + i)), y + i);
}
void asin_of(const float* x, float* y, std::size_t n) {
    for (std::size_t i = 0; i < n; i += lanes) store(asin(load(x + i)), y + i);
}
void atan2_of(const float* y, const float* x, float* a, std::size_t n) {
    for (std::size_t i = 0; i < n; i += lanes) store(atan2(load(y + i), load(x + i)), a + i);
}
void power_of(const float* x, std::int32_t exponent, float* y, std::size_t n) {
    for (std::size_t i = 0; i < n; i += lanes) store(power(load(x + i), Int(exponent)), y + i);
}
// Samples `first` to `first + 15` of one pixel.
void samples_of(std::int32_t x, std::int32_t y, std::uint32_t seed, std::uint32_t first, bool aperture, float* u,
                float* v) {
    const Int key = pixel_key(Int(x), Int(y), seed);
    for (std::uint32_t i = 0; i < 16; ++i) {
        const Point2 p = aperture ? aperture_sample(key, first + i) : pixel_sample(key, first + i);
        u[i] = lane(p.x, 0);
        v[i] = lane(p.y, 0);
    }
}
void disk_of(const float* u, const float* v, float* x, float* y) {
    const Point2 p = square_to_disk({load(u), load(v)});
    store(p.x, x);
    store(p.y, y);
}
float stratum_cell_of(std::uint32_t side, std::uint32_t stratum, std::uint32_t sample, std::uint32_t seed,
                      std::uint32_t& cell) {
    const StratumCell choice = stratum_cell(side, stratum, sample, seed);
    cell = choice.cell;
    return choice.cells;
}

}  // namespace

extern const MathInLanes math;
const MathInLanes math = {exp_of, asin_of, atan2_of, power_of, samples_of, disk_of, stratum_cell_of};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
