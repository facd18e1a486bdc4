// Every random choice: a function of pixel, sample index and seed only, in exact 32-bit arithmetic, so that a picture
// does not depend on threads, tiles, the order of work or the instruction set.
#pragma once

#include <cstdint>

#include "tracer/kernels/lanes/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Two numbers in [0, 1) per lane.
struct Point2 {
    Real x, y;
};

HWY_INLINE std::uint32_t scramble(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

// The same in lanes. Ellis, "Hash Prospector" (2018): a bijection whose every output bit depends on every input bit.
HWY_INLINE Int scramble(Int x) {
    x = (x ^ shift_right<16>(x)) * Int(0x7feb352d);
    x = (x ^ shift_right<15>(x)) * Int(static_cast<std::int32_t>(0x846ca68bu));
    return x ^ shift_right<16>(x);
}

// A word of 2^-32 steps to [0, 1): its upper 24 bits, exactly.
HWY_INLINE Real unit_interval(Int word) { return to_real(shift_right<8>(word)) * Real(0x1p-24f); }

// Random word of each pixel (x, y < 2^16), the start of every choice made there.
HWY_INLINE Int pixel_key(Int x, Int y, std::uint32_t seed) {
    return scramble((shift_left<16>(y) | x) ^ Int(static_cast<std::int32_t>(scramble(seed + 0x9e3779b9u))));
}

// Point n of a Kronecker sequence with steps (step_x, step_y) 2^-32, shifted by two words of the pixel: any stretch of
// it covers the unit square evenly, and no two pixels see the same one.
HWY_INLINE Point2 kronecker(std::uint32_t n, std::uint32_t step_x, std::uint32_t step_y, std::uint32_t start,
                            Int shift_x, Int shift_y) {
    return {unit_interval(shift_x + Int(static_cast<std::int32_t>(start + n * step_x))),
            unit_interval(shift_y + Int(static_cast<std::int32_t>(start + n * step_y)))};
}

// Where sample n lies in its pixel: the centre for n = 0, then Roberts' R2 sequence (2018), whose steps are 1 / p and
// 1 / p^2 for the plastic number p.
HWY_INLINE Point2 pixel_sample(Int key, std::uint32_t n) {
    if (n == 0) return {Real(0.5f), Real(0.5f)};
    return kronecker(n, 0xc13fa9a9u, 0x91e10da6u, 0x80000000u, scramble(key ^ Int(0x3c6ef372)),
                     scramble(key ^ Int(0x5a827999)));
}

// Where sample n lies in the unit square that is mapped to the aperture. The steps, 2 cos(2 pi / 7) and its square,
// come from another cubic field than the plastic number: the two pairs are independent.
HWY_INLINE Point2 aperture_sample(Int key, std::uint32_t n) {
    return kronecker(n, 0x3f3a0e29u, 0x8e11bc74u, 0, scramble(key ^ Int(0x1b873593)), scramble(key ^ Int(0x2545f491)));
}

// One cell of a side x side grid of light points (side > 4) for each of sixteen strata, quarters of its sides: where a
// sample goes, and how many cells it stands for. Each cell of a stratum comes up once in as many samples as it has
// cells, so that the mean over samples is the mean over cells.
inline constexpr std::uint32_t strata = 16;
struct StratumCell {
    std::uint32_t cell;  // row * side + column
    float cells;
};
inline StratumCell stratum_cell(std::uint32_t side, std::uint32_t stratum, std::uint32_t sample, std::uint32_t seed) {
    const std::uint32_t i = stratum / 4, j = stratum % 4;
    const std::uint32_t first_row = side * i / 4, rows = side * (i + 1) / 4 - first_row;
    const std::uint32_t first_column = side * j / 4, columns = side * (j + 1) / 4 - first_column;
    // Row by row, every time around shifted by one column and every row by a golden section of them: a Latin square's
    // order, begun elsewhere in each stratum.
    const std::uint32_t start = scramble(seed + stratum * 0x9e3779b9u) % (rows * columns) + sample % (rows * columns);
    const std::uint32_t row = start % rows, round = start / rows;
    const std::uint32_t skew = (columns * 5 + 4) / 8;
    const std::uint32_t column = (round + row * skew) % columns;
    return {(first_row + row) * side + first_column + column, static_cast<float>(rows * columns)};
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
