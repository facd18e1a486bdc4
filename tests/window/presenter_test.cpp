// Frames drawn into memory by the commands that draw windows: every way from the staging buffer to the picture.
#include "app/display/presenter.h"
#include "app/display/no_display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "app/display/fit.h"
#include "app/display/frame_writer.h"
#include "tracer/rendering/resolve.h"

namespace raywalk {
namespace {

using Picture = std::vector<std::uint32_t>;

Picture noise(int width, int height, std::uint32_t seed) {
    std::mt19937 random(seed);
    Picture picture(static_cast<std::size_t>(width) * height);
    for (std::uint32_t& word : picture) word = 0xff000000u | (random() & 0xffffff);
    return picture;
}

Picture shown(OffscreenPresenter& presenter, const Picture& picture, int width, int height, int window_width,
              int window_height) {
    publish_picture(presenter.exchange(), {}, width, height, picture);
    return presenter.present(window_width, window_height);
}

int greatest_difference(const Picture& a, const Picture& b) {
    if (a.size() != b.size()) return 256;
    int greatest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (const int shift : {0, 8, 16, 24})
            greatest = std::max(
                greatest, std::abs(static_cast<int>(a[i] >> shift & 255) - static_cast<int>(b[i] >> shift & 255)));
    return greatest;
}

// A film whose tiles have had different numbers of samples, some none; sums go from below 0 to above 1 a sample.
Film some_film(int width, int height) {
    Film film(width, height);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(-0.2f, 1.3f);
    for (std::size_t tile = 0; tile < film.tiles.size(); ++tile) {
        film.samples[tile] = static_cast<std::uint32_t>(tile % 4);
        for (auto& channel : film.tiles[tile].rgb)
            for (float& sum : channel) sum = value(random) * static_cast<float>(tile % 4);
    }
    return film;
}

TEST(Offscreen, AFrameOfTheWindowsSizeIsCopiedBitForBit) {
    OffscreenPresenter presenter;
    const std::pair<int, int> sizes[] = {{1, 1}, {64, 48}, {1280, 720}, {7, 300}, {1000, 3}, {64, 48}};
    for (const auto& [width, height] : sizes) {
        const Picture picture = noise(width, height, 1);
        EXPECT_EQ(shown(presenter, picture, width, height, width, height), picture) << width << " x " << height;
        EXPECT_EQ(presenter.last_path(), FramePath::copy);
    }
}

TEST(Offscreen, TheNewestFrameIsShownAgainUntilThereIsAnother) {
    OffscreenPresenter presenter;
    const Picture first = noise(40, 30, 1), second = noise(40, 30, 2);
    EXPECT_EQ(shown(presenter, first, 40, 30, 40, 30), first);
    EXPECT_EQ(presenter.present(40, 30), first);
    EXPECT_EQ(shown(presenter, second, 40, 30, 40, 30), second);
}

TEST(Offscreen, TheShaderScalesAPreviewAsTheProcessorDoes) {
    OffscreenPresenter presenter;
    const std::pair<int, int> sizes[] = {{320, 180}, {160, 90}, {427, 240}, {853, 480}};
    for (const auto& [width, height] : sizes) {
        // Soft, as pictures are; the two filters of devices that have the time for a sharper one agree on such too.
        Picture picture(static_cast<std::size_t>(width) * height);
        upscale(noise(8, 6, 3), 8, 6, picture, width, height);
        Picture expected(1280 * 720);
        upscale(picture, width, height, expected, 1280, 720);
        EXPECT_LE(greatest_difference(shown(presenter, picture, width, height, 1280, 720), expected), 3)
            << width << " x " << height;
        EXPECT_EQ(presenter.last_path(), FramePath::scale);
    }
}

TEST(Offscreen, APictureOfAnotherShapeStandsInBlack) {
    OffscreenPresenter presenter;
    const Picture white(100 * 100, 0xffffffffu);
    const Picture window = shown(presenter, white, 100, 100, 400, 200);
    const Rectangle where = fit(100, 100, 400, 200);
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 400; ++x) {
            const bool inside = x >= where.x && x < where.x + where.width && y >= where.y && y < where.y + where.height;
            ASSERT_EQ(window[y * 400 + x], inside ? 0xffffffffu : 0xff000000u) << x << ", " << y;
        }
}

TEST(Offscreen, TheDeviceResolvesRadianceToTheProcessorsBits) {
    OffscreenPresenter presenter;
    const Kernels& kernels = *select_kernels();
    const std::pair<int, int> sizes[] = {{64, 64}, {200, 120}, {61, 43}, {5, 3}};
    for (const auto& [width, height] : sizes) {
        const Film film = some_film(width, height);
        Picture expected(static_cast<std::size_t>(width) * height);
        resolve_into(expected, film, kernels, 0.9f, 1);
        publish_film(presenter.exchange(), FrameContent::radiance, {}, film, kernels, 0.9f, 1);
        EXPECT_EQ(presenter.present(width, height), expected) << width << " x " << height;
        EXPECT_EQ(presenter.last_path(), FramePath::resolve);
        publish_film(presenter.exchange(), FrameContent::display, {}, film, kernels, 0.9f, 1);
        EXPECT_EQ(presenter.present(width, height), expected) << width << " x " << height;
        EXPECT_EQ(presenter.last_path(), FramePath::copy);
    }
}

TEST(Offscreen, TheDeviceScalesWhatItResolved) {
    OffscreenPresenter presenter;
    const Kernels& kernels = *select_kernels();
    const Film film = some_film(160, 90);
    publish_film(presenter.exchange(), FrameContent::radiance, {}, film, kernels, 1, 1);
    const Picture by_device = presenter.present(640, 360);
    EXPECT_EQ(presenter.last_path(), FramePath::resolve_and_scale);
    publish_film(presenter.exchange(), FrameContent::display, {}, film, kernels, 1, 1);
    EXPECT_EQ(presenter.present(640, 360), by_device);
    EXPECT_EQ(presenter.last_path(), FramePath::scale);
}

TEST(Offscreen, TheProcessorOrTheDeviceResolvesAsAsked) {
    ASSERT_EQ(setenv("RAYWALK_RESOLVE", "device", 1), 0);
    EXPECT_EQ(OffscreenPresenter().preferred_content(), FrameContent::radiance);
    ASSERT_EQ(setenv("RAYWALK_RESOLVE", "processor", 1), 0);
    EXPECT_EQ(OffscreenPresenter().preferred_content(), FrameContent::display);
    unsetenv("RAYWALK_RESOLVE");
}

TEST(Offscreen, NoDriverIsToldWithWhatToDo) {
    const char* old = std::getenv("VK_DRIVER_FILES");
    const std::string drivers = old ? old : "";
    ASSERT_EQ(setenv("VK_DRIVER_FILES", "/nonexistent", 1), 0);
    try {
        OffscreenPresenter presenter;
        ADD_FAILURE() << "a presenter without a driver";
    } catch (const NoDisplayError& error) {
        EXPECT_NE(
            std::string(error.what()).find("VK_DRIVER_FILES names the only drivers that may be used, '/nonexistent'"),
            std::string::npos)
            << error.what();
    }
    old ? setenv("VK_DRIVER_FILES", drivers.c_str(), 1) : unsetenv("VK_DRIVER_FILES");
}

}  // namespace
}  // namespace raywalk
