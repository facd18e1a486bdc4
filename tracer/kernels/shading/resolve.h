// Sums of samples to display values (spec 4.8).
#pragma once

#include <cstdint>
#include <cstring>

#include "tracer/kernels/lanes/lanes.h"
#include "tracer/picture/film.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// round(255 clamp(sum * scale, 0, 1)); 0 for NaN. No fused operations: every instruction set gives the same bytes.
HWY_INLINE Int display_value(Real sum, Real scale) {
    const Real clamped = min(max(sum * scale, Real(0.0f)), Real(1.0f));
    return truncate_to_int(clamped * Real(255.0f) + Real(0.5f));
}

inline void resolve_pixels(const FilmTile& tile, float scale, int columns, int rows, std::uint32_t* out,
                           int row_stride) {
    HWY_ALIGN std::int32_t words[lanes];
    for (int group = 0; group < tile_pixels / lanes; ++group) {
        const int at = group * lanes;
        const Int red = display_value(load(tile.rgb[0] + at), Real(scale));
        const Int green = display_value(load(tile.rgb[1] + at), Real(scale));
        const Int blue = display_value(load(tile.rgb[2] + at), Real(scale));
        store(Int(static_cast<std::int32_t>(0xff000000u)) | shift_left<16>(red) | shift_left<8>(green) | blue, words);

        const int x = tile_pixel_x(at), y = tile_pixel_y(at);
        for (int row = 0; row < 4 && y + row < rows; ++row) {
            const int count = columns - x < 4 ? columns - x : 4;
            if (count <= 0) break;
            std::memcpy(out + static_cast<std::ptrdiff_t>(y + row) * row_stride + x, words + row * 4,
                        static_cast<std::size_t>(count) * sizeof(std::uint32_t));
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
