#include "tracer/rendering/film.h"

#include <algorithm>

namespace raywalk {

void Film::resize(int pixels_wide, int pixels_high) {
    width = pixels_wide;
    height = pixels_high;
    tiles_x = (width + tile_size - 1) / tile_size;
    tiles_y = (height + tile_size - 1) / tile_size;
    const std::size_t count = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
    tiles.resize(count);
    samples.resize(count);
    clear();
}

void Film::clear() { std::fill(samples.begin(), samples.end(), 0); }

namespace {

// Calls visit(x, y, tile, lane) for each pixel of the picture, tile by tile.
template <class Visit>
void for_each_pixel(const Film& film, const Visit& visit) {
    for (int ty = 0; ty < film.tiles_y; ++ty)
        for (int tx = 0; tx < film.tiles_x; ++tx) {
            const std::size_t tile =
                static_cast<std::size_t>(ty) * static_cast<std::size_t>(film.tiles_x) + static_cast<std::size_t>(tx);
            for (int lane = 0; lane < tile_pixels; ++lane) {
                const int x = tx * tile_size + tile_pixel_x(lane), y = ty * tile_size + tile_pixel_y(lane);
                if (x < film.width && y < film.height) visit(x, y, tile, lane);
            }
        }
}

}  // namespace

FloatImage mean_radiance(const Film& film) {
    FloatImage image{.width = film.width, .height = film.height, .rgb = {}};
    image.rgb.resize(static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height) * 3);
    for_each_pixel(film, [&](int x, int y, std::size_t tile, int lane) {
        if (film.samples[tile] == 0) return;
        const float scale = film_scale(1, film.samples[tile]);
        float* pixel = &image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) +
                                   static_cast<std::size_t>(x)) *
                                  3];
        for (int channel = 0; channel < 3; ++channel) pixel[channel] = film.tiles[tile].rgb[channel][lane] * scale;
    });
    return image;
}

float normalizing_exposure(const Film& film) {
    float largest = 1;
    for_each_pixel(film, [&](int, int, std::size_t tile, int lane) {
        if (film.samples[tile] == 0) return;
        const float scale = film_scale(1, film.samples[tile]);
        for (const auto& channel : film.tiles[tile].rgb) largest = std::max(largest, channel[lane] * scale);
    });
    return 1 / largest;
}

}  // namespace raywalk
