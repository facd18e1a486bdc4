// Elementary functions and samples in lanes, on every instruction set of this machine.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "tests/kernels/math_lanes.h"
#include "tracer/ground/aligned.h"
#include "tracer/kernels/instruction_sets.h"

namespace raywalk {

// Each is defined by math_lanes.cpp, compiled for its instruction set.
namespace N_AVX3 {
extern const MathInLanes math;
}
namespace N_AVX2 {
extern const MathInLanes math;
}
namespace N_SSE4 {
extern const MathInLanes math;
}
namespace N_SCALAR {
extern const MathInLanes math;
}

namespace {

// Runs `check` once for each instruction set that this machine has.
template <class Check>
void on_every_target(const Check& check) {
    const std::int64_t targets = runnable_targets();
    const auto run = [&](std::int64_t target, const char* name, const MathInLanes& math) {
        if ((targets & target) != target) return;
        SCOPED_TRACE(name);
        check(math);
    };
#ifdef RAYWALK_AVX512
    run(HWY_AVX3, "avx512", N_AVX3::math);
#endif
#ifdef RAYWALK_AVX2
    run(HWY_AVX2, "avx2", N_AVX2::math);
#endif
#ifdef RAYWALK_SSE4
    run(HWY_SSE4, "sse4", N_SSE4::math);
#endif
    run(0, "scalar", N_SCALAR::math);
}

// n steps from a to b.
AlignedVector<float> steps(double a, double b, std::size_t n) {
    AlignedVector<float> values(n);
    for (std::size_t i = 0; i < n; ++i)
        values[i] = static_cast<float>(a + (b - a) * static_cast<double>(i) / static_cast<double>(n - 1));
    return values;
}

alignas(64) const float awkward[] = {0.0f,  -0.0f,  1e-45f, -1e-45f, 1e-38f, -1e-38f, 1.0f, -1.0f,
                                     3e38f, -3e38f, 88.8f,  -87.4f,  1e10f,  -1e10f,  0.5f, -0.5f};

constexpr std::size_t count = 1 << 18;

TEST(KernelMath, ExpIsWithin3e7OverItsWholeRange) {
    const AlignedVector<float> x = steps(-87, 88, count);
    AlignedVector<float> y(count);
    on_every_target([&](const MathInLanes& math) {
        math.exp_of(x.data(), y.data(), count);
        for (std::size_t i = 0; i < count; ++i)
            ASSERT_NEAR(y[i] / std::exp(static_cast<double>(x[i])), 1, 3e-7) << x[i];
    });
}

TEST(KernelMath, ExpGoesToZeroAndNeverToNan) {
    on_every_target([&](const MathInLanes& math) {
        alignas(64) float y[16];
        math.exp_of(awkward, y, 16);
        for (const float value : y) EXPECT_TRUE(std::isfinite(value));
        EXPECT_EQ(y[9], 0.0f);   // exp(-3e38)
        EXPECT_EQ(y[11], 0.0f);  // exp(-87.4)
        EXPECT_EQ(y[0], 1.0f);
    });
}

TEST(KernelMath, AsinIsWithin4e7OverItsWholeRange) {
    const AlignedVector<float> x = steps(-1, 1, count);
    AlignedVector<float> y(count);
    on_every_target([&](const MathInLanes& math) {
        math.asin_of(x.data(), y.data(), count);
        for (std::size_t i = 0; i < count; ++i) ASSERT_NEAR(y[i], std::asin(static_cast<double>(x[i])), 4e-7) << x[i];
        alignas(64) float limited[16];
        math.asin_of(awkward, limited, 16);
        for (const float value : limited) EXPECT_LE(std::abs(value), 1.5707964f);
    });
}

TEST(KernelMath, Atan2IsWithin6e7InEveryDirectionAtEveryScale) {
    AlignedVector<float> x(count), y(count), a(count);
    for (const double scale : {1e-30, 1e-6, 1.0, 1e12, 4e37}) {
        const AlignedVector<float> angles = steps(-std::numbers::pi, std::numbers::pi, count);
        for (std::size_t i = 0; i < count; ++i) {
            x[i] = static_cast<float>(scale * std::cos(static_cast<double>(angles[i])));
            y[i] = static_cast<float>(scale * std::sin(static_cast<double>(angles[i])));
        }
        on_every_target([&](const MathInLanes& math) {
            math.atan2_of(y.data(), x.data(), a.data(), count);
            for (std::size_t i = 0; i < count; ++i)
                ASSERT_NEAR(a[i], std::atan2(static_cast<double>(y[i]), static_cast<double>(x[i])), 6e-7)
                    << y[i] << ", " << x[i];
        });
    }
}

TEST(KernelMath, Atan2OfFiniteNumbersIsNeverNan) {
    on_every_target([&](const MathInLanes& math) {
        for (const float y : awkward) {
            alignas(64) float ys[16], a[16];
            std::fill(std::begin(ys), std::end(ys), y);
            math.atan2_of(ys, awkward, a, 16);
            for (const float value : a) EXPECT_LE(std::abs(value), 3.1415928f);
        }
        alignas(64) const float zero[16] = {};
        alignas(64) float a[16];
        math.atan2_of(zero, zero, a, 16);
        EXPECT_EQ(a[0], 0.0f);
    });
}

TEST(KernelMath, PowerSquaresItsWay) {
    const AlignedVector<float> x = steps(0, 1, 1 << 12);
    AlignedVector<float> y(x.size());
    on_every_target([&](const MathInLanes& math) {
        for (const int n : {0, 1, 2, 5, 7, 64, 100}) {
            math.power_of(x.data(), n, y.data(), x.size());
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double exact = std::pow(static_cast<double>(x[i]), n);
                ASSERT_NEAR(y[i], exact, 1.3e-7 * n * exact + 1e-37) << x[i] << "^" << n;
            }
        }
    });
}

TEST(KernelSamples, FirstLiesInTheMiddleOfThePixel) {
    on_every_target([&](const MathInLanes& math) {
        alignas(64) float u[16], v[16];
        math.samples_of(5, 7, 3, 0, false, u, v);
        EXPECT_EQ(u[0], 0.5f);
        EXPECT_EQ(v[0], 0.5f);
    });
}

// Any stretch of n^2 samples leaves no square of side 2.2 / n empty: white noise leaves many.
TEST(KernelSamples, AnyStretchCoversThePixelEvenly) {
    for (const bool aperture : {false, true})
        for (const std::uint32_t first : {1u, 16u, 1000u, 4'000'000'000u}) {
            AlignedVector<float> u(256), v(256);
            for (std::uint32_t i = 0; i < 256; i += 16)
                N_SCALAR::math.samples_of(100, 30, 1, first + i, aperture, &u[i], &v[i]);
            const int cells = 7;  // 256 = 16^2
            std::set<int> covered;
            for (std::size_t i = 0; i < 256; ++i) {
                ASSERT_GE(std::min(u[i], v[i]), 0.0f);
                ASSERT_LT(std::max(u[i], v[i]), 1.0f);
                covered.insert(static_cast<int>(u[i] * cells) * cells + static_cast<int>(v[i] * cells));
            }
            EXPECT_EQ(covered.size(), static_cast<std::size_t>(cells * cells))
                << first << (aperture ? " aperture" : "");
        }
}

TEST(KernelSamples, AreTheSameBitsOnEveryInstructionSet) {
    AlignedVector<float> first;
    on_every_target([&](const MathInLanes& math) {
        AlignedVector<float> all;
        for (const bool aperture : {false, true}) {
            alignas(64) float u[16], v[16];
            math.samples_of(16383, 12345, 99, 70'000, aperture, u, v);
            all.insert(all.end(), u, u + 16);
            all.insert(all.end(), v, v + 16);
        }
        if (first.empty()) first = all;
        EXPECT_EQ(first, all);
    });
}

TEST(KernelSamples, DifferByPixelAndBySeed) {
    alignas(64) float u[4][16], v[16];
    N_SCALAR::math.samples_of(10, 10, 0, 1, false, u[0], v);
    N_SCALAR::math.samples_of(11, 10, 0, 1, false, u[1], v);
    N_SCALAR::math.samples_of(10, 11, 0, 1, false, u[2], v);
    N_SCALAR::math.samples_of(10, 10, 1, 1, false, u[3], v);
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) EXPECT_GT(std::abs(u[a][0] - u[b][0]), 1e-3f);
}

// Evenly by area: half of the disk's area lies within r = sqrt(1/2), a quarter in each quadrant.
TEST(KernelSamples, FillTheApertureEvenly) {
    constexpr std::uint32_t samples = 4096;
    int inner = 0, quadrants[4] = {};
    for (std::uint32_t i = 0; i < samples; i += 16) {
        alignas(64) float u[16], v[16], x[16], y[16];
        N_SCALAR::math.samples_of(3, 4, 5, i, true, u, v);
        N_SCALAR::math.disk_of(u, v, x, y);
        for (int k = 0; k < 16; ++k) {
            const float squared = x[k] * x[k] + y[k] * y[k];
            ASSERT_LE(squared, 1.000001f);
            inner += squared < 0.5f;
            ++quadrants[(x[k] > 0 ? 1 : 0) + (y[k] > 0 ? 2 : 0)];
        }
    }
    EXPECT_NEAR(inner, samples / 2.0, samples / 100.0);
    for (const int in_quadrant : quadrants) EXPECT_NEAR(in_quadrant, samples / 4.0, samples / 100.0);
}

TEST(KernelSamples, SquaresCentreIsTheDisksCentre) {
    alignas(64) const float half[16] = {0.5f};
    alignas(64) float x[16], y[16];
    N_SCALAR::math.disk_of(half, half, x, y);
    EXPECT_EQ(x[0], 0.0f);
    EXPECT_EQ(y[0], 0.0f);
}

// The cells that sixteen strata choose, and for how many cells they stand.
std::vector<double> chosen(std::uint32_t side, std::uint32_t samples, std::uint32_t seed) {
    std::vector<double> weight(side * side);
    for (std::uint32_t sample = 0; sample < samples; ++sample)
        for (std::uint32_t stratum = 0; stratum < 16; ++stratum) {
            std::uint32_t cell = 0;
            const float cells = N_SCALAR::math.stratum_cell_of(side, stratum, sample + 4'000'000'000u, seed, cell);
            weight.at(cell) += cells / samples;
        }
    return weight;
}

TEST(KernelSamples, EveryLightPointHasTheSameShareInTheEnd) {
    for (const std::uint32_t side : {5u, 6u, 7u, 8u, 20u, 32u})
        for (const std::uint32_t seed : {0u, 1u, 77u}) {
            // As many samples as all strata have in common: (side / 4)^2, or both sizes of stratum where 4 does not
            // divide.
            const std::uint32_t a = side / 4, b = (side + 3) / 4;
            const std::vector<double> weight = chosen(side, a == b ? a * a : a * a * b * b, seed);
            for (const double w : weight) ASSERT_NEAR(w, 1, 1e-5) << side;
        }
}

TEST(KernelSamples, EverySampleOfALightSpreadsOverAllOfIt) {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        const std::vector<double> weight = chosen(20, 1, seed);
        double quarter[16] = {};
        for (std::size_t cell = 0; cell < weight.size(); ++cell)
            quarter[cell / 20 / 5 * 4 + cell % 20 / 5] += weight[cell];
        for (const double w : quarter) EXPECT_EQ(w, 25);
    }
}

}  // namespace
}  // namespace raywalk
