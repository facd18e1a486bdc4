// Tracing beside the window: whatever comes and goes, the last view is what ends up in the frames, with every sample.
#include "app/walk/render_thread.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <random>

#include "app/display/frame_writer.h"
#include "app/walk/walk.h"
#include "tracer/compiled/compile.h"
#include "tracer/rendering/resolve.h"

namespace raywalk {
namespace {

Scene balls_on_a_floor() {
    Scene scene;
    scene.viewer.center = {0, 2, 8};
    scene.viewer.target = {0, 1, 0};
    scene.lights.emplace_back();
    scene.lights[0].origin = {3, 6, 4};
    scene.lights[0].intensity = 3;  // radiance over 1: the exposure matters
    scene.planes.emplace_back().texture.pattern = GridTexture{1};
    for (int i = -2; i <= 2; ++i) scene.spheres.emplace_back().center = {2.0 * i, 1, 0};
    return scene;
}

// The thread with its frames in plain memory, and a display that takes every one.
class Bench {
  public:
    explicit Bench(std::uint32_t limit, std::optional<float> exposure = {}) : limit_(limit), exposure_(exposure) {
        scene_ = compile(description_, {}, {});
        renderer_ = std::make_unique<Renderer>(scene_, nullptr, 2);
        opening = {.camera = opening_camera(description_.viewer, 1.5),
                   .width = 96,
                   .height = 64,
                   .settings = {.seed = 1, .one_shot = limit == 1}};
    }

    std::unique_ptr<RenderThread> start(const View& view) {
        return std::make_unique<RenderThread>(*renderer_, exchange_,
                                              RenderThread::Setup{.opening = opening,
                                                                  .exposure = exposure_,
                                                                  .sample_limit = limit_,
                                                                  .until_still = until_still,
                                                                  .frame_ready = [this] { note_frame(); }},
                                              view);
    }

    // The frame of the view `id` that has every sample; takes all on the way and checks their order.
    std::vector<std::uint32_t> finished_frame(std::uint64_t id) {
        std::unique_lock lock(mutex_);
        const FrameSlot* frame = nullptr;
        std::uint64_t last = 0;
        const bool came = ready_.wait_for(lock, std::chrono::seconds(60), [&] {
            frame = exchange_.take();
            if (!frame) return false;
            EXPECT_GE(frame->info.camera_id, last) << "a frame of an older view";
            last = frame->info.camera_id;
            if (frame->info.finished) finished_at = frame->info.samples;
            return last == id && frame->info.finished;
        });
        EXPECT_TRUE(came) << "the last view never got its samples";
        if (!came) return {};
        const auto* words = reinterpret_cast<const std::uint32_t*>(frame->data);
        return {words, words + static_cast<std::size_t>(frame->info.width) * frame->info.height};
    }

    // The same by the renderer alone: exposure of the opening view, then every sample of this one.
    std::vector<std::uint32_t> expected(const View& view, float factor = 1) {
        Renderer renderer(scene_, nullptr, 1);
        const std::atomic<bool> never = false;
        renderer.set_view(opening);
        renderer.render_until(1, never);
        const float exposure = exposure_.value_or(normalizing_exposure(renderer.film())) * factor;
        renderer.set_view(view);
        renderer.render_until(limit_, never);
        std::vector<std::uint32_t> picture(static_cast<std::size_t>(view.width) * view.height);
        resolve_into(picture, renderer.film(), renderer.kernels(), exposure, 1);
        return picture;
    }

    // Whether a frame of the view `id` is waiting to be shown.
    bool has_frame(std::uint64_t id) {
        const FrameSlot* frame = exchange_.take();
        return frame != nullptr && frame->info.camera_id == id;
    }

    View opening;
    bool until_still = false;
    std::uint32_t finished_at = 0;  // samples of the last finished frame

  private:
    void note_frame() {
        const std::lock_guard lock(mutex_);
        ready_.notify_all();
    }

    Scene description_ = balls_on_a_floor();
    CompiledScene scene_;
    std::unique_ptr<Renderer> renderer_;
    std::uint32_t limit_;
    std::optional<float> exposure_;
    std::vector<std::unique_ptr<std::uint64_t[]>> memory_{3};
    FrameExchange exchange_{[this](FrameSlot& slot, std::size_t bytes) {
        memory_[slot.index] = std::make_unique<std::uint64_t[]>(bytes / 8 + 1);
        slot.data = reinterpret_cast<std::byte*>(memory_[slot.index].get());
        slot.capacity = bytes;
    }};
    std::mutex mutex_;
    std::condition_variable ready_;
};

TEST(RenderThread, AStandingViewGetsEverySampleOfThePlainRenderer) {
    for (const std::uint32_t limit : {1u, 2u, 37u}) {
        Bench bench(limit);
        const auto render = bench.start(bench.opening);
        EXPECT_EQ(bench.finished_frame(1), bench.expected(bench.opening)) << limit << " samples";
        EXPECT_EQ(bench.finished_at, limit);
    }
}

TEST(RenderThread, TheExposureIsThatOfTheOpeningViewWhereverTheWalkStarts) {
    Bench bench(3);
    View view = bench.opening;
    view.camera = walk(view.camera, {.forward = 5});
    const auto render = bench.start(view);
    EXPECT_EQ(bench.finished_frame(1), bench.expected(view));
}

TEST(RenderThread, TheLastOfManyViewsWins) {
    Bench bench(5);
    const auto render = bench.start(bench.opening);
    bench.finished_frame(1);
    std::mt19937 random(3);
    View view = bench.opening;
    std::uint64_t id = 1;
    for (int round = 0; round < 10; ++round) {
        for (int i = 0; i < 50; ++i) {
            view.camera =
                walk(view.camera, {.forward = (random() % 3) * 0.1 - 0.1, .turn_right = (random() % 3) - 1.0});
            if (random() % 8 == 0) view.camera = toggled_projection(view.camera);
            if (random() % 10 == 0) view.width = 40 + static_cast<int>(random() % 100);
            id = render->show(view, random() % 2 == 0);
            if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
        }
        EXPECT_EQ(render->show(view, false), id) << "the same view is no change";
        EXPECT_EQ(bench.finished_frame(id), bench.expected(view)) << "round " << round;
    }
}

TEST(RenderThread, AnotherExposureCostsNoSample) {
    Bench bench(4, 0.5f);
    const auto render = bench.start(bench.opening);
    bench.finished_frame(1);
    const double traced = render->traced_seconds();
    render->expose(2);
    const auto brighter = bench.expected(bench.opening, 2);
    for (int i = 0; i < 600 && bench.finished_frame(1) != brighter; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(bench.finished_frame(1), brighter);
    render->expose(1);  // a factor of the first exposure, not of the last
    const auto first = bench.expected(bench.opening);
    for (int i = 0; i < 600 && bench.finished_frame(1) != first; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(bench.finished_frame(1), first);
    render->stop();
    EXPECT_EQ(render->traced_seconds(), traced);
}

TEST(RenderThread, EndsEarlierWhereTwiceTheSamplesChangeNoValue) {
    Bench bench(64);
    bench.until_still = true;
    const auto render = bench.start(bench.opening);
    bench.finished_frame(1);
    EXPECT_EQ(bench.finished_at, 64u) << "edges and highlights still change";
    View away = bench.opening;
    away.camera.direction = {0, 1, 0};  // nothing but black
    away.camera.up = {0, 0, 1};
    bench.finished_frame(render->show(away, false));
    EXPECT_EQ(bench.finished_at, 32u) << "as at 16";
    bench.finished_frame(render->show(bench.opening, false));
    EXPECT_EQ(bench.finished_at, 64u) << "another view begins anew";
}

TEST(RenderThread, TracesNothingWhileItRests) {
    Bench bench(3);
    const auto render = bench.start(bench.opening);
    bench.finished_frame(1);
    render->rest(true);
    View view = bench.opening;
    view.camera = walk(view.camera, {.forward = 1});
    const std::uint64_t id = render->show(view, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(bench.has_frame(id));
    render->rest(false);
    EXPECT_EQ(bench.finished_frame(id), bench.expected(view));
}

TEST(RenderThread, EndsAtOnceWhileThereIsMuchToDo) {
    Bench bench(1'000'000'000);
    View view = bench.opening;
    view.width = view.height = 1000;
    const auto begin = std::chrono::steady_clock::now();
    bench.start(view)->stop();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace raywalk
