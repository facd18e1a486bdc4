// The elementary functions and samples of one instruction set, as plain functions that a test can call.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raywalk {

// Arrays are whole sixteens, 64-byte aligned; n counts their values.
struct MathInLanes {
    void (*exp_of)(const float* x, float* y, std::size_t n);
    void (*asin_of)(const float* x, float* y, std::size_t n);
    void (*atan2_of)(const float* y, const float* x, float* angle, std::size_t n);
    void (*power_of)(const float* x, std::int32_t exponent, float* y, std::size_t n);
    // Samples `first` to `first + 15` of one pixel, of its area or of the aperture.
    void (*samples_of)(std::int32_t x, std::int32_t y, std::uint32_t seed, std::uint32_t first, bool aperture, float* u,
                       float* v);
    void (*disk_of)(const float* u, const float* v, float* x, float* y);
    // The cell that a stratum of side x side light points chooses; returns for how many cells it stands.
    float (*stratum_cell_of)(std::uint32_t side, std::uint32_t stratum, std::uint32_t sample, std::uint32_t seed,
                             std::uint32_t& cell);
};

}  // namespace raywalk
