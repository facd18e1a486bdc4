#include "tracer/picture/film.h"

#include <gtest/gtest.h>

#include <set>

namespace raywalk {
namespace {

// Every pixel of the film at its own value: x, y, x + y times the samples.
Film numbered_film(int width, int height, std::uint32_t samples) {
    Film film(width, height);
    for (int tile = 0; tile < film.tiles_x * film.tiles_y; ++tile) {
        film.samples[static_cast<std::size_t>(tile)] = samples;
        for (int lane = 0; lane < tile_pixels; ++lane) {
            const int x = tile % film.tiles_x * tile_size + tile_pixel_x(lane);
            const int y = tile / film.tiles_x * tile_size + tile_pixel_y(lane);
            FilmTile& sums = film.tiles[static_cast<std::size_t>(tile)];
            sums.rgb[0][lane] = static_cast<float>(x) * static_cast<float>(samples);
            sums.rgb[1][lane] = static_cast<float>(y) * static_cast<float>(samples);
            sums.rgb[2][lane] = static_cast<float>(x + y) * static_cast<float>(samples);
        }
    }
    return film;
}

TEST(Film, ATileHasEachOfItsPixelsOnce) {
    std::set<std::pair<int, int>> pixels;
    for (int lane = 0; lane < tile_pixels; ++lane) pixels.emplace(tile_pixel_x(lane), tile_pixel_y(lane));
    EXPECT_EQ(pixels.size(), 64u);
    EXPECT_EQ(*pixels.begin(), std::pair(0, 0));
    EXPECT_EQ(*pixels.rbegin(), std::pair(7, 7));
}

TEST(Film, TilesCoverSizesThatAreNoMultipleOfEight) {
    const Film film(17, 8);
    EXPECT_EQ(film.tiles_x, 3);
    EXPECT_EQ(film.tiles_y, 1);
    EXPECT_EQ(film.tiles.size(), 3u);
}

TEST(Film, MeanRadianceIsTheSumOverTheSamplesWithRowsFromTheTop) {
    const FloatImage image = mean_radiance(numbered_film(13, 9, 4));
    ASSERT_EQ(image.rgb.size(), 13u * 9 * 3);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 13; ++x) {
            const float* pixel = &image.rgb[static_cast<std::size_t>(y * 13 + x) * 3];
            EXPECT_EQ(pixel[0], static_cast<float>(x));
            EXPECT_EQ(pixel[1], static_cast<float>(y));
            EXPECT_EQ(pixel[2], static_cast<float>(x + y));
        }
}

TEST(Film, TilesWithoutASampleAreBlackWhateverTheyHeldBefore) {
    Film film = numbered_film(16, 8, 1);
    film.clear();
    for (const float value : mean_radiance(film).rgb) EXPECT_EQ(value, 0);
    EXPECT_EQ(normalizing_exposure(film), 1);
}

TEST(Film, NormalizingBringsTheLargestChannelToOneAndNeverBrightens) {
    EXPECT_FLOAT_EQ(normalizing_exposure(numbered_film(5, 4, 3)), 1.0f / 7);
    Film dim(8, 8);
    dim.samples[0] = 2;
    dim.tiles[0] = {};
    dim.tiles[0].rgb[1][7] = 1.0f;  // a mean of one half
    EXPECT_EQ(normalizing_exposure(dim), 1);
    dim.tiles[0].rgb[1][7] = 8.0f;
    EXPECT_EQ(normalizing_exposure(dim), 0.25f);
}

TEST(Film, NormalizingLooksAtNoPixelBeyondTheEdge) {
    Film film(3, 3);
    film.samples[0] = 1;
    film.tiles[0] = {};
    film.tiles[0].rgb[0][63] = 100;  // pixel (7, 7)
    EXPECT_EQ(normalizing_exposure(film), 1);
}

TEST(Film, AnotherSizeHasNoSamples) {
    Film film = numbered_film(16, 16, 2);
    film.resize(24, 8);
    EXPECT_EQ(film.tiles.size(), 3u);
    for (const std::uint32_t samples : film.samples) EXPECT_EQ(samples, 0u);
    EXPECT_EQ(film_scale(3, 0), 0);
}

}  // namespace
}  // namespace raywalk
