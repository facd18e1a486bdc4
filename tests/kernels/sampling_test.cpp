// Many samples a pixel: antialiasing, depth of field, points of area lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/kernels/scene.h"

namespace raywalk {
namespace {

// A wall so small in the picture that all samples see the same point; one area light, and a ball that hides some of it.
Scene lit_by_area(int n) {
    Scene scene;
    scene.viewer = viewer_along_z(8, 8, 1e-4);
    scene.planes.push_back(
        {.texture = surface({1, 1, 1}, {"shiny", 0, 0.3, 5, 0, 0}), .normal = {0, 0, 1}, .offset = -10});
    scene.lights.push_back(
        {.origin = {1, 2, -4}, .color = {1, 0.7, 0.4}, .intensity = 1, .area = AreaSpread{.n = n, .radius = 1.5}});
    scene.spheres.push_back({.texture = surface({1, 1, 1}, matte), .center = {0.7, 0.9, -7}, .radius = 0.6});
    return scene;
}

double mean_of(const Picture& picture) {
    double sum = 0;
    for (const glm::vec3& pixel : picture.pixels) sum += pixel.x;
    return sum / static_cast<double>(picture.pixels.size());
}

TEST(AreaLight, OneShotUsesEveryPoint) {
    const Scene scene = lit_by_area(9);
    const Picture picture = picture_of(scene);
    EXPECT_LE(picture.counts.shadow, 64u * 81u);
    EXPECT_GE(picture.counts.shadow, 64u * 80u);  // but those behind the wall
    Scene points = scene;
    points.lights.clear();
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            const double a = 2 * M_PI * i / 9, b = 2 * M_PI * j / 9;
            const glm::dvec3 offset(std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b));
            points.lights.push_back({.origin = glm::dvec3(1, 2, -4) + 1.5 * offset,
                                     .color = {1, 0.7, 0.4},
                                     .intensity = 1.0 / 81,
                                     .area = {}});
        }
    EXPECT_EQ(share_of_differing(picture, picture_of(points), 1e-6), 0);
}

// Every point comes up once in each round of samples, so that their mean is the light's, exactly.
TEST(AreaLight, SamplesHaveTheMeanOfAllPoints) {
    for (const int n : {4, 8, 12, 20, 32}) {
        const Scene scene = lit_by_area(n);
        const double all = mean_of(picture_of(scene));
        for (const std::uint32_t seed : {0u, 5u}) {
            const std::uint32_t round = static_cast<std::uint32_t>(n * n / 16);
            const Picture sampled = picture_of(scene, {.samples = round, .seed = seed, .one_shot = false});
            EXPECT_NEAR(mean_of(sampled), all, 1e-5 * all) << n;
            EXPECT_LE(sampled.counts.shadow, 64u * 16u * round);
        }
    }
}

// The ball hides two thirds of the light. Sixteen points chosen at random would be off by a third of the light on
// average (0.47 sqrt(1 / 16) / 0.35), and by a twelfth after 16 samples.
TEST(AreaLight, AFewSamplesAreNearTheMeanAlready) {
    const Scene scene = lit_by_area(32);
    const double all = mean_of(picture_of(scene));
    const auto mean_error = [&](std::uint32_t samples) {
        double sum = 0;
        for (std::uint32_t seed = 0; seed < 16; ++seed)
            sum +=
                std::abs(mean_of(picture_of(scene, {.samples = samples, .seed = seed, .one_shot = false})) / all - 1);
        return sum / 16;
    };
    EXPECT_LE(mean_error(1), 0.25);
    EXPECT_LE(mean_error(16), 0.03);
}

// Sixteen points or fewer are all used in every sample.
TEST(AreaLight, SmallOnesAreNeverSampled) {
    const Scene scene = lit_by_area(4);
    EXPECT_NEAR(mean_of(picture_of(scene, {.samples = 1, .seed = 0, .one_shot = false})), mean_of(picture_of(scene)),
                1e-7);
}

// The edge of a lit half plane: a pixel's mean is the share of it that is covered.
TEST(Antialiasing, PixelsOnAnEdgeShowTheShareCovered) {
    Scene scene;
    scene.viewer = viewer_along_z(16, 16, 40);
    scene.viewer.viewport = {16, 16};
    // Every point of it glows as bright; the edge runs along y = 0.3 x + 0.1.
    scene.faces.push_back({.texture = surface({1, 1, 1}, {"glow", 1, 0, 0, 0, 0}),
                           .a = {-100, -29.9, -5},
                           .b = {100, 30.1, -5},
                           .c = {0, -900, -5}});
    const Picture one = picture_of(scene);
    const Picture many = picture_of(scene, {.samples = 256, .seed = 3, .one_shot = false});
    for (int x = 3; x < 13; ++x) {
        // Covered area of the column's pixels, counted from below, up to the edge.
        double covered = 0, full = 0;
        for (int y = 0; y < 16; ++y) {
            const double brightness = one.at(x, 15).x;
            covered += many.at(x, y).x / brightness;
            full += one.at(x, y).x / brightness;
        }
        const double left = x - 8, height = 8 + 0.3 * (left + 0.5) + 0.1;
        EXPECT_NEAR(covered, height, 0.1) << x;
        EXPECT_NEAR(full, height, 0.7) << x;
    }
}

// Where a plane of focus is, the picture is as sharp as a pinhole's.
TEST(DepthOfField, FocusPlaneIsSharp) {
    Scene scene;
    scene.viewer = viewer_along_z(64, 64, 60);
    scene.planes.push_back({.texture = {matte, GridTexture{1}}, .normal = {0, 0, 1}, .offset = -8});
    scene.lights.push_back({.origin = {0, 0, -4}, .color = glm::dvec3(1), .intensity = 1, .area = {}});
    const PictureOptions options = {.samples = 8, .seed = 0, .one_shot = false};
    const Picture pinhole = picture_of(scene, options);
    scene.viewer.depth_of_field = DepthOfField{.aperture_radius = 0.4, .focal_distance = 8, .samples = 1};
    const Picture focused = picture_of(scene, options);
    scene.viewer.depth_of_field->focal_distance = 5;
    const Picture blurred = picture_of(scene, options);
    // Each sample meets the plane where the pinhole's does; only the way there is a little longer or shorter.
    EXPECT_LE(share_of_differing(pinhole, focused, 0.01), 0.002);
    EXPECT_GE(share_of_differing(pinhole, blurred, 0.01), 0.3);
}

// A bright point at distance d blurs to a disk of radius aperture |d - f| / d on the focal plane, evenly bright.
TEST(DepthOfField, BlurHasTheRadiusOfTheCircleOfConfusion) {
    for (const double distance : {6.0, 20.0}) {
        const double focus = 10, aperture = 0.5, fovy = 20;
        Scene scene;
        scene.viewer = viewer_along_z(101, 101, fovy);
        scene.viewer.depth_of_field = DepthOfField{.aperture_radius = aperture, .focal_distance = focus, .samples = 1};
        const double radius = 0.02 * distance / focus;
        scene.spheres.push_back(
            {.texture = surface({1, 1, 1}, {"glow", 1, 0, 0, 0, 0}), .center = {0, 0, -distance}, .radius = radius});
        const Picture picture = picture_of(scene, {.samples = 400, .seed = 1, .one_shot = false});
        const double pixels_per_unit = 101 / (2 * focus * std::tan(fovy / 360 * M_PI));
        const double expected = aperture * std::abs(distance - focus) / distance * pixels_per_unit;
        double sum = 0, second_moment = 0, farthest = 0;
        for (int y = 0; y < 101; ++y)
            for (int x = 0; x < 101; ++x) {
                const double squared = (x - 50) * (x - 50) + (y - 50) * (y - 50), value = picture.at(x, y).x;
                sum += value;
                second_moment += value * squared;
                if (value > 0) farthest = std::max(farthest, std::sqrt(squared));
            }
        ASSERT_GT(sum, 0);
        EXPECT_NEAR(farthest, expected, 1.6) << distance;
        // Of an even disk: r^2 / 2.
        EXPECT_NEAR(std::sqrt(2 * second_moment / sum), expected, 0.6) << distance;
    }
}

// A sample depends on pixel, index and seed only: neither on how samples are grouped nor on what came before.
TEST(Samples, AddUpTheSameWhateverTheGrouping) {
    Scene scene = lit_by_area(8);
    scene.viewer.fovy_degrees = 40;
    scene.viewer.depth_of_field = DepthOfField{.aperture_radius = 0.3, .focal_distance = 8, .samples = 1};
    const CompiledScene ready = compiled(scene);
    const Camera camera = opening_camera(scene.viewer, 1);
    const Kernels& kernels = *select_kernels();
    const TileScratchPointer scratch = make_tile_scratch();
    RayCounts counts;
    TileJob job{
        .scene = &ready, .camera = &camera, .settings = {.seed = 4, .one_shot = false}, .width = 8, .height = 8};
    FilmTile together = {}, apart = {};
    job.sample_count = 7;
    kernels.trace_tile(job, *scratch, together, counts);
    job.sample_count = 1;
    for (job.first_sample = 0; job.first_sample < 7; ++job.first_sample)
        kernels.trace_tile(job, *scratch, apart, counts);
    for (int channel = 0; channel < 3; ++channel)
        for (int lane = 0; lane < tile_pixels; ++lane) EXPECT_EQ(together.rgb[channel][lane], apart.rgb[channel][lane]);
}

TEST(Samples, OnlyPixelsOfThePictureAreCountedAndTraced) {
    Scene scene;
    scene.viewer = viewer_along_z(13, 11, 60);
    scene.planes.push_back({.texture = surface({1, 1, 1}, matte), .normal = {0, 0, 1}, .offset = -5});
    scene.lights.push_back({.origin = {0, 0, 0}, .color = glm::dvec3(1), .intensity = 1, .area = {}});
    const Picture picture = picture_of(scene, {.samples = 3, .seed = 0, .one_shot = false});
    EXPECT_EQ(picture.counts, (RayCounts{.camera = 3 * 143, .shadow = 3 * 143}));
    EXPECT_GT(picture.at(12, 10).x, 0);
}

}  // namespace
}  // namespace raywalk
