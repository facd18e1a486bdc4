// Accumulated radiance, stored tile by tile in the order in which the kernels make it.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/ground/aligned.h"
#include "tracer/scene/image.h"

namespace raywalk {

inline constexpr int tile_size = 8;                        // pixels a side
inline constexpr int tile_pixels = tile_size * tile_size;  // 64 = four groups of 4x4 = four registers of 16 lanes

// Pixel `lane` of a tile: group lane / 16 is the 4x4 block at (4 (g & 1), 4 (g >> 1)), rows of four inside it.
constexpr int tile_pixel_x(int lane) { return ((lane >> 4) & 1) * 4 + (lane & 3); }
constexpr int tile_pixel_y(int lane) { return (lane >> 5) * 4 + ((lane >> 2) & 3); }

// Sums of samples of one tile: rgb[channel][lane]. Linear radiance.
struct alignas(64) FilmTile {
    float rgb[3][tile_pixels];
};

struct Film {
    int width = 0, height = 0;             // pixels
    int tiles_x = 0, tiles_y = 0;          // ceil(size / tile_size); lanes beyond the edge are traced into nothing
    AlignedVector<FilmTile> tiles;         // row by row
    AlignedVector<std::uint32_t> samples;  // per tile: how many are summed

    Film() = default;
    Film(int pixels_wide, int pixels_high) { resize(pixels_wide, pixels_high); }
    // Another size, and no samples. Memory is kept for the next size.
    void resize(int pixels_wide, int pixels_high);
    // Forgets the samples; the sums of a tile are set to zero when its next first sample is traced.
    void clear();
};

// Where a tile lies in the picture, and how much of it lies inside.
struct TileRectangle {
    int x, y, columns, rows;  // pixels
};
TileRectangle tile_rectangle(const Film& film, int tile);

// The one factor between a tile's sums and its values, so that files and windows agree bit for bit: every value is
// sum * film_scale(exposure, samples). 0 for no samples.
inline float film_scale(float exposure, std::uint32_t samples) {
    return samples == 0 ? 0.0f : exposure / static_cast<float>(samples);
}

// Mean radiance, rows from the top; tiles without a sample are black. The rows are read from the film as they are asked
// for, and it has to stay.
FloatRows radiance_rows(const Film& film);
FloatImage mean_radiance(const Film& film);
// Factor that brings the largest channel of the mean to 1 where it is over 1, else 1 (spec 4.8 `normalize`).
float normalizing_exposure(const Film& film);

}  // namespace raywalk
