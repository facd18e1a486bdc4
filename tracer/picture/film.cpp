#include "tracer/picture/film.h"

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

TileRectangle tile_rectangle(const Film& film, int tile) {
    const int x = tile % film.tiles_x * tile_size, y = tile / film.tiles_x * tile_size;
    return {x, y, std::min(tile_size, film.width - x), std::min(tile_size, film.height - y)};
}

void Film::clear() { std::fill(samples.begin(), samples.end(), 0); }

namespace {

// Calls visit(x, y, tile, lane) for each pixel of the rows [begin, end), tile by tile.
template <class Visit>
void for_each_pixel(const Film& film, int begin, int end, const Visit& visit) {
    for (int ty = begin / tile_size; ty * tile_size < end; ++ty)
        for (int tx = 0; tx < film.tiles_x; ++tx) {
            const std::size_t tile =
                static_cast<std::size_t>(ty) * static_cast<std::size_t>(film.tiles_x) + static_cast<std::size_t>(tx);
            for (int lane = 0; lane < tile_pixels; ++lane) {
                const int x = tx * tile_size + tile_pixel_x(lane), y = ty * tile_size + tile_pixel_y(lane);
                if (x < film.width && y >= begin && y < end) visit(x, y, tile, lane);
            }
        }
}

}  // namespace

FloatRows radiance_rows(const Film& film) {
    const auto read = [&film](int begin, int end, float* rgb) {
        for_each_pixel(film, begin, end, [&](int x, int y, std::size_t tile, int lane) {
            const float scale = film_scale(1, film.samples[tile]);
            float* pixel = &rgb[(static_cast<std::size_t>(y - begin) * static_cast<std::size_t>(film.width) +
                                 static_cast<std::size_t>(x)) *
                                3];
            for (int channel = 0; channel < 3; ++channel)
                pixel[channel] = scale == 0 ? 0 : film.tiles[tile].rgb[channel][lane] * scale;
        });
    };
    return {.width = film.width, .height = film.height, .read = read};
}

FloatImage mean_radiance(const Film& film) {
    const std::size_t pixels = static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
    FloatImage image{.width = film.width, .height = film.height, .rgb = std::vector<float>(pixels * 3)};
    radiance_rows(film).read(0, film.height, image.rgb.data());
    return image;
}

float normalizing_exposure(const Film& film) {
    float largest = 1;
#pragma omp parallel for schedule(static) reduction(max : largest)
    for (int ty = 0; ty < film.tiles_y; ++ty) {
        const int begin = ty * tile_size, end = std::min(begin + tile_size, film.height);
        for_each_pixel(film, begin, end, [&](int, int, std::size_t tile, int lane) {
            if (film.samples[tile] == 0) return;
            const float scale = film_scale(1, film.samples[tile]);
            for (const auto& channel : film.tiles[tile].rgb) largest = std::max(largest, channel[lane] * scale);
        });
    }
    return 1 / largest;
}

}  // namespace raywalk
