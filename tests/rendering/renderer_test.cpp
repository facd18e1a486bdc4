#include "tracer/rendering/renderer.h"
#include "tracer/compiled/compile.h"
#include "tracer/rendering/resolve.h"

#include <gtest/gtest.h>

#include <cstring>
#include <mutex>
#include <set>

namespace raywalk {
namespace {

// A room of everything: an area light, a mirror, glass, a grid, triangles.
CompiledScene test_scene() {
    Scene scene;
    const auto texture = [](int material, auto pattern) {
        return Texture{.material = materials[material], .pattern = pattern};
    };
    scene.lights.push_back(
        {.origin = {2, 5, 0}, .color = {1, 1, 1}, .intensity = 1, .area = AreaSpread{.n = 3, .radius = 0.5}});
    scene.lights.push_back({.origin = {0, 0, 1}, .color = {1, 1, 0}, .intensity = 0.25, .area = {}});
    scene.planes.push_back({.texture = texture(0, GridTexture{.density = 2}), .normal = {0, 1, 0}, .offset = -1});
    scene.spheres.push_back(
        {.texture = texture(1, PureTexture{{0, 0, 0}}), .center = {-1.5, 0, -6}, .radius = 1, .refraction_index = 1});
    scene.spheres.push_back(
        {.texture = texture(3, PureTexture{{0, 0, 0}}), .center = {1, 0, -4}, .radius = 0.8, .refraction_index = 1.5});
    scene.spheres.push_back(
        {.texture = texture(4, PureTexture{{0, 1, 1}}), .center = {0.5, 0, -8}, .radius = 1, .refraction_index = 1});
    scene.faces.push_back(
        {.texture = texture(4, PureTexture{{1, 0, 0}}), .a = {-4, -1, -10}, .b = {4, -1, -10}, .c = {0, 4, -10}});
    return compile(scene, {}, {});
}

View view_of(int width, int height, bool one_shot = false) {
    View view;
    view.camera.orthographic_half = {3, 3};
    view.camera.half_height = 0.5;
    view.camera.aperture_radius = 0.05;
    view.camera.focal_distance = 6;
    view.width = width;
    view.height = height;
    view.settings = {.seed = 7, .one_shot = one_shot};
    return view;
}

const std::atomic<bool> never = false;

bool same_bits(const FloatImage& a, const FloatImage& b) {
    return a.rgb.size() == b.rgb.size() && std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

FloatImage rendered(const CompiledScene& scene, const View& view, std::uint32_t samples, int threads) {
    Renderer renderer(scene, nullptr, threads);
    renderer.set_view(view);
    EXPECT_TRUE(renderer.render_until(samples, never));
    EXPECT_EQ(renderer.samples(), samples);
    return mean_radiance(renderer.film());
}

TEST(Renderer, ThePictureIsTheSameForAnyNumberOfThreads) {
    const CompiledScene scene = test_scene();
    for (const std::uint32_t samples : {1u, 5u}) {
        const View view = view_of(93, 61, samples == 1);
        const FloatImage one = rendered(scene, view, samples, 1);
        for (const int threads : {2, 7, 16})
            EXPECT_TRUE(same_bits(one, rendered(scene, view, samples, threads))) << threads;
    }
}

TEST(Renderer, SamplesOneByOneAreTheSamplesAtOnce) {
    const CompiledScene scene = test_scene();
    const View view = view_of(70, 50);
    Renderer renderer(scene, nullptr, 2);
    renderer.set_view(view);
    for (std::uint32_t i = 1; i <= 11; ++i) {
        EXPECT_TRUE(renderer.render_until(i, never));
        EXPECT_EQ(renderer.samples(), i);
    }
    EXPECT_TRUE(same_bits(mean_radiance(renderer.film()), rendered(scene, view, 11, 3)));
}

TEST(Renderer, APictureThatWasCancelledGoesOnToTheSameBits) {
    const CompiledScene scene = test_scene();
    const View view = view_of(70, 50);
    Renderer renderer(scene, nullptr, 2);
    renderer.set_view(view);
    int cancelled = 0;
    for (int finished_tiles = 3;; finished_tiles += 5) {
        std::atomic<bool> cancel = false;
        std::atomic<int> tiles = 0;
        if (renderer.render_until(9, cancel, [&](int) {
                if (++tiles >= finished_tiles) cancel = true;
            }))
            break;
        EXPECT_LT(renderer.samples(), 9u);
        ++cancelled;
    }
    EXPECT_GT(cancelled, 0);
    EXPECT_TRUE(same_bits(mean_radiance(renderer.film()), rendered(scene, view, 9, 1)));
}

TEST(Renderer, CancelledBeforeItBeginsItTracesNothing) {
    const CompiledScene scene = test_scene();
    Renderer renderer(scene, nullptr, 2);
    renderer.set_view(view_of(64, 64));
    const std::atomic<bool> cancel = true;
    EXPECT_FALSE(renderer.render_until(3, cancel));
    EXPECT_EQ(renderer.samples(), 0u);
    EXPECT_EQ(renderer.ray_counts(), RayCounts{});
    for (const float value : mean_radiance(renderer.film()).rgb) EXPECT_EQ(value, 0);
}

TEST(Renderer, EveryTileIsToldOnceWhenItIsDone) {
    const CompiledScene scene = test_scene();
    Renderer renderer(scene, nullptr, 3);
    renderer.set_view(view_of(50, 30));
    std::mutex mutex;
    std::multiset<int> tiles;
    renderer.render_until(6, never, [&](int tile) {
        const std::lock_guard lock(mutex);
        tiles.insert(tile);
    });
    EXPECT_EQ(tiles.size(), 7u * 4);
    EXPECT_EQ(std::set<int>(tiles.begin(), tiles.end()).size(), tiles.size());
}

TEST(Renderer, OnlyAChangeOfTheViewRestarts) {
    const CompiledScene scene = test_scene();
    Renderer renderer(scene, nullptr, 2);
    const View view = view_of(32, 32);
    renderer.set_view(view);
    renderer.render_until(2, never);
    renderer.set_view(view);
    EXPECT_EQ(renderer.samples(), 2u);
    std::vector<View> others(6, view);
    others[0].camera.eye.x += 1e-9;
    others[1].camera = toggled_projection(view.camera);
    others[2].width = 40;
    others[3].settings.seed = 8;
    others[4].settings.one_shot = true;
    others[5].camera.focal_distance = 7;
    for (const View& other : others) {
        renderer.set_view(other);
        EXPECT_EQ(renderer.samples(), 0u);
        EXPECT_EQ(renderer.ray_counts(), RayCounts{});
        renderer.render_until(1, never);
        EXPECT_EQ(renderer.samples(), 1u);
        renderer.set_view(view);
        renderer.render_until(2, never);
    }
    EXPECT_TRUE(same_bits(mean_radiance(renderer.film()), rendered(scene, view, 2, 1)));
}

TEST(Renderer, CountsOneCameraRayPerPixelAndSample) {
    const CompiledScene scene = test_scene();
    Renderer renderer(scene, nullptr, 2);
    renderer.set_view(view_of(50, 30));
    renderer.render_until(3, never);
    const RayCounts counts = renderer.ray_counts();
    EXPECT_EQ(counts.camera, 50u * 30 * 3);
    EXPECT_GT(counts.shadow, 0u);
    EXPECT_GT(counts.reflection, 0u);
    EXPECT_GT(counts.refraction, 0u);
    EXPECT_EQ(counts.dropped_samples, 0u);
}

TEST(Renderer, SeedsChangeThePictureAndRepeatIt) {
    const CompiledScene scene = test_scene();
    View view = view_of(40, 40);
    const FloatImage first = rendered(scene, view, 2, 2);
    EXPECT_TRUE(same_bits(first, rendered(scene, view, 2, 2)));
    view.settings.seed = 8;
    EXPECT_FALSE(same_bits(first, rendered(scene, view, 2, 2)));
}

TEST(Renderer, DisplayValuesAreTheRoundedMeanTimesTheExposure) {
    const CompiledScene scene = test_scene();
    Renderer renderer(scene, nullptr, 2);
    renderer.set_view(view_of(37, 21));
    renderer.render_until(3, never);
    const FloatImage mean = mean_radiance(renderer.film());
    const std::vector<std::uint8_t> bytes = display_values(renderer.film(), renderer.kernels(), 1.5f);
    ASSERT_EQ(bytes.size(), mean.rgb.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
        ASSERT_NEAR(bytes[i], 255 * std::min(1.0f, mean.rgb[i] * 1.5f), 0.5 + 1e-3) << i;
}

}  // namespace
}  // namespace raywalk
