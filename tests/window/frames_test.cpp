// Frames on their way from the tracer to the screen: sizes by time, slots that change hands, places in the window.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "app/display/fit.h"
#include "app/display/frame_exchange.h"
#include "app/display/frame_writer.h"
#include "app/walk/frame_pacing.h"

namespace raywalk {
namespace {

constexpr glm::ivec2 window_size{1280, 720};

double pixels(glm::ivec2 size) { return static_cast<double>(size.x) * size.y; }

// So many frames of a scene that costs so much a pixel.
void trace(FramePacing& pacing, double seconds_per_pixel, int frames) {
    for (int i = 0; i < frames; ++i) {
        const double n = pixels(pacing.size(window_size));
        pacing.measured(n, n * seconds_per_pixel, window_size);
    }
}

TEST(FramePacing, TheFirstFrameIsSmall) {
    const FramePacing pacing;
    EXPECT_LT(pixels(pacing.size(window_size)) * 30, pixels(window_size));
}

TEST(FramePacing, AFastSceneIsTracedAtFullSize) {
    FramePacing pacing;
    trace(pacing, 0.01 / pixels(window_size), 3);
    EXPECT_EQ(pacing.size(window_size), window_size);
}

TEST(FramePacing, FramesOfASlowSceneTakeTheTimeOfAFrame) {
    for (const double full_frame : {0.05, 0.2, 1.0, 5.0}) {
        FramePacing pacing;
        trace(pacing, full_frame / pixels(window_size), 40);
        const double seconds = pixels(pacing.size(window_size)) * full_frame / pixels(window_size);
        EXPECT_LE(seconds, 1.0 / 60) << full_frame;
        // A step between two sizes is at most 2.25 times the pixels, and the larger has to leave a fifth of the time.
        EXPECT_GE(seconds, 1.0 / 75 * 0.8 / 2.25) << full_frame << ": not smaller than need be";
    }
}

TEST(FramePacing, TwoLateFramesShrinkTheNextOnes) {
    FramePacing pacing;
    trace(pacing, 0.01 / pixels(window_size), 10);
    trace(pacing, 1.0 / pixels(window_size), 2);
    EXPECT_LE(pixels(pacing.size(window_size)) * 1.0 / pixels(window_size), 1.0 / 30 * 1.5);
}

TEST(FramePacing, OneLateFrameIsForgiven) {
    FramePacing pacing;
    trace(pacing, 0.2 / pixels(window_size), 30);
    const glm::ivec2 size = pacing.size(window_size);
    trace(pacing, 2.0 / pixels(window_size), 1);
    EXPECT_EQ(pacing.size(window_size), size);
    trace(pacing, 0.2 / pixels(window_size), 3);
    EXPECT_EQ(pacing.size(window_size), size);
}

TEST(FramePacing, TimesThatScatterDoNotMakeTheSizeHop) {
    FramePacing pacing;
    trace(pacing, 0.2 / pixels(window_size), 30);
    int hops = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::ivec2 before = pacing.size(window_size);
        trace(pacing, 0.2 * (i % 2 ? 1.1 : 0.9) / pixels(window_size), 1);
        hops += pacing.size(window_size) != before;
    }
    EXPECT_LE(hops, 1);
}

TEST(FramePacing, TheShapeOfTheWindowIsKept) {
    FramePacing pacing;
    trace(pacing, 1.0 / pixels(window_size), 3);
    for (const glm::ivec2 size : {glm::ivec2{1280, 720}, {500, 900}, {641, 479}}) {
        const glm::ivec2 small = pacing.size(size);
        EXPECT_NEAR(static_cast<double>(small.x) * size.y / size.x, small.y, 1) << size.x << " x " << size.y;
        EXPECT_EQ(fit(small.x, small.y, size.x, size.y), (Rectangle{0, 0, size.x, size.y}));
    }
}

TEST(FramePacing, NoWindowIsTooSmall) {
    FramePacing pacing;
    trace(pacing, 1.0, 5);
    EXPECT_EQ(pacing.size({1, 1}), (glm::ivec2{1, 1}));
    EXPECT_GE(pacing.size({4000, 1}).y, 1);
}

TEST(Fit, APictureOfAnotherShapeIsCentredWhole) {
    EXPECT_EQ(fit(100, 100, 400, 200), (Rectangle{100, 0, 200, 200}));
    EXPECT_EQ(fit(100, 100, 200, 400), (Rectangle{0, 100, 200, 200}));
    EXPECT_EQ(fit(1600, 900, 800, 600), (Rectangle{0, 75, 800, 450}));
    EXPECT_EQ(fit(10000, 1, 100, 100), (Rectangle{0, 49, 100, 1}));
}

TEST(FrameExchange, TheNewestWholeFrameArrivesWhateverTheThreadsDo) {
    std::vector<std::unique_ptr<std::byte[]>> memory(3);
    FrameExchange exchange([&](FrameSlot& slot, std::size_t bytes) {
        memory[slot.index] = std::make_unique<std::byte[]>(bytes);
        slot.data = memory[slot.index].get();
        slot.capacity = bytes;
    });
    EXPECT_EQ(exchange.take(), nullptr);
    constexpr std::uint32_t frames = 20000;
    std::thread writer([&] {
        for (std::uint32_t n = 1; n <= frames; ++n) {
            const std::size_t words = 16 + n % 50;
            FrameSlot& slot = exchange.begin_write(words * sizeof n);
            for (std::size_t i = 0; i < words; ++i) std::memcpy(slot.data + i * sizeof n, &n, sizeof n);
            slot.info.samples = n;
            slot.info.width = static_cast<int>(words);
            exchange.publish();
        }
    });
    std::uint32_t last = 0;
    while (last < frames) {
        const FrameSlot* frame = exchange.take();
        if (!frame) continue;
        ASSERT_GE(frame->info.samples, last) << "an older frame";
        last = frame->info.samples;
        for (int i = 0; i < frame->info.width; ++i) {
            std::uint32_t word = 0;
            std::memcpy(&word, frame->data + static_cast<std::size_t>(i) * sizeof word, sizeof word);
            ASSERT_EQ(word, last) << "a frame that is still written to";
        }
    }
    writer.join();
    EXPECT_FALSE(exchange.fresh());
    EXPECT_EQ(exchange.take()->info.samples, frames) << "stays until there is another";
}

TEST(Upscale, KeepsEvenColoursAndStraightRamps) {
    const std::vector<std::uint32_t> even(12, 0xff4080c0u);
    std::vector<std::uint32_t> large(60 * 45);
    upscale(even, 4, 3, large, 60, 45);
    for (const std::uint32_t word : large) ASSERT_EQ(word, 0xff4080c0u);

    std::vector<std::uint32_t> ramp(16 * 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 16; ++x) ramp[y * 16 + x] = 0xff000000u | static_cast<std::uint32_t>(16 * x) << 8;
    std::vector<std::uint32_t> wide(64 * 8);
    upscale(ramp, 16, 2, wide, 64, 8);
    for (int x = 2; x < 62; ++x)
        EXPECT_NEAR(static_cast<int>(wide[64 * 3 + x] >> 8 & 255), 16 * ((x + 0.5) / 4 - 0.5), 1) << x;
}

TEST(Upscale, TheSameSizeIsTheSamePicture) {
    std::vector<std::uint32_t> picture(7 * 5), copy(7 * 5);
    for (std::size_t i = 0; i < picture.size(); ++i)
        picture[i] = 0xff000000u | static_cast<std::uint32_t>(i * 2654435761u >> 8);
    upscale(picture, 7, 5, copy, 7, 5);
    EXPECT_EQ(picture, copy);
}

}  // namespace
}  // namespace raywalk
