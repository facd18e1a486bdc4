#include "tracer/rendering/resolve.h"

#include <omp.h>

#include <algorithm>

namespace raywalk {

void resolve_into(std::span<std::uint32_t> picture, const Film& film, int tile, const Kernels& kernels,
                  float exposure) {
    const TileRectangle r = tile_rectangle(film, tile);
    const auto width = static_cast<std::size_t>(film.width);
    std::uint32_t* out = &picture[static_cast<std::size_t>(r.y) * width + static_cast<std::size_t>(r.x)];
    const std::uint32_t samples = film.samples[static_cast<std::size_t>(tile)];
    if (samples > 0) {
        kernels.resolve_tile(film.tiles[static_cast<std::size_t>(tile)], film_scale(exposure, samples), r.columns,
                             r.rows, out, film.width);
        return;
    }
    for (int row = 0; row < r.rows; ++row)
        std::fill_n(out + static_cast<std::size_t>(row) * width, r.columns, 0xff000000u);
}

void resolve_into(std::span<std::uint32_t> picture, const Film& film, const Kernels& kernels, float exposure,
                  int threads) {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int tile = 0; tile < static_cast<int>(film.tiles.size()); ++tile)
        resolve_into(picture, film, tile, kernels, exposure);
}

std::vector<std::uint8_t> rgb_bytes(std::span<const std::uint32_t> words) {
    std::vector<std::uint8_t> bytes(words.size() * 3);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            bytes[3 * i + channel] = static_cast<std::uint8_t>(words[i] >> (16 - 8 * channel));
    return bytes;
}

std::vector<std::uint8_t> display_values(const Film& film, const Kernels& kernels, float exposure) {
    std::vector<std::uint32_t> words(static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height));
    resolve_into(words, film, kernels, exposure, omp_get_max_threads());
    return rgb_bytes(words);
}

}  // namespace raywalk
