// One source, every instruction set: what must agree bit for bit, and how far the others may differ.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "hwy/targets.h"
#include "tests/kernels/scene.h"
#include "tracer/kernels/instruction_sets.h"

namespace raywalk {
namespace {

// Glass, mirrors, grids, an area light and a floor: every path of shading.
Scene everything() {
    Scene scene;
    scene.viewer = viewer_along_z(123, 91, 60);
    scene.planes.push_back({.texture = {materials[0], GridTexture{2}}, .normal = {0, 1, 0}, .offset = -2});
    scene.planes.push_back(
        {.texture = {materials[2], PureTexture{{0.1, 0.1, 0.2}}}, .normal = {0, 0, 1}, .offset = -16});
    std::mt19937 random(1);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    for (int i = 0; i < 30; ++i)
        scene.spheres.push_back({.texture = {materials[random() % std::size(materials)], GridTexture{4}},
                                 .center = {between(-6, 6), between(-2, 3), between(-15, -6)},
                                 .radius = between(0.2, 1),
                                 .refraction_index = 1.5});
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 a(between(-6, 6), between(-2, 3), between(-15, -6));
        scene.faces.push_back({.texture = surface({1, 0.8, 0.1}, materials[random() % std::size(materials)]),
                               .a = a,
                               .b = a + glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1)),
                               .c = a + glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1))});
    }
    scene.lights.push_back({.origin = {3, 6, 0}, .color = {1, 1, 0.9}, .intensity = 1, .area = {}});
    scene.lights.push_back(
        {.origin = {-3, 5, -8}, .color = {0.5, 0.7, 1}, .intensity = 1, .area = AreaSpread{.n = 5, .radius = 0.5}});
    return scene;
}

struct View {
    const char* name;
    bool orthographic, blurred;
};

Picture seen(const View& view, const PictureOptions& options) {
    Scene scene = everything();
    if (view.orthographic) scene.viewer.viewport = {14, 10.4};
    if (view.blurred)
        scene.viewer.depth_of_field = DepthOfField{.aperture_radius = 0.1, .focal_distance = 9, .samples = 1};
    return picture_of(scene, options);
}

constexpr View views[] = {
    {"perspective", false, false}, {"orthographic", true, false}, {"depth of field", false, true}};

// Whether mul_add rounds once.
bool fuses(const Kernels& kernels) { return kernels.name == "avx2" || kernels.name == "avx512"; }

bool same_bits(const Picture& a, const Picture& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

TEST(Widths, PicturesAreTheSameBitsWhereMultiplyAddRoundsAlike) {
    for (const View& view : views)
        for (const bool fused : {false, true}) {
            std::optional<Picture> first;
            for (const Kernels* kernels : available_kernels()) {
                if (fuses(*kernels) != fused) continue;
                const Picture picture =
                    seen(view, {.samples = 2, .seed = 1, .one_shot = false, .kernels = kernels->name});
                if (!first) first = picture;
                EXPECT_TRUE(same_bits(*first, picture)) << view.name << " " << kernels->name;
                EXPECT_EQ(first->counts, picture.counts) << view.name << " " << kernels->name;
            }
        }
}

// One rounding or two move a ray by about 1e-7 of its length: pixels at edges, or behind several curved mirrors and
// lenses, can change; the others stay within a hundredth of a display step.
TEST(Widths, PicturesAreTheSameToTheEyeEverywhere) {
    for (const View& view : views) {
        const Picture best = seen(view, {});
        const Picture scalar = seen(view, {.kernels = "scalar"});
        EXPECT_LE(share_of_differing(best, scalar, 0.01 / 255), 0.01) << view.name;
        EXPECT_LE(share_of_differing(best, scalar, 1.0 / 255), 0.004) << view.name;
    }
}

TEST(Widths, ThreadsDoNotShow) {
    const Picture one = seen(views[0], {.samples = 3, .seed = 2, .one_shot = false, .threads = 1});
    for (const int threads : {2, 7, 16}) {
        const Picture many = seen(views[0], {.samples = 3, .seed = 2, .one_shot = false, .threads = threads});
        EXPECT_TRUE(same_bits(one, many)) << threads;
        EXPECT_EQ(one.counts, many.counts) << threads;
    }
}

TEST(Kernels, AreFoundByName) {
    ASSERT_FALSE(available_kernels().empty());
    EXPECT_EQ(select_kernels(), available_kernels().front());
    EXPECT_EQ(available_kernels().back()->name, "scalar");
    for (const Kernels* kernels : available_kernels()) EXPECT_EQ(select_kernels(kernels->name), kernels);
    EXPECT_EQ(select_kernels("mmx"), nullptr);
    for (std::size_t i = 1; i < available_kernels().size(); ++i)
        EXPECT_GT(available_kernels()[i - 1]->lanes, available_kernels()[i]->lanes);
}

TEST(Kernels, AreThoseThatHighwayFindsRunnable) {
    constexpr std::int64_t ours = HWY_SSE4 | HWY_AVX2 | HWY_AVX3;
    EXPECT_EQ(runnable_targets(), hwy::SupportedTargets() & ours);
}

std::uint32_t display_word(const FilmTile& tile, int lane, float scale) {
    std::uint32_t word = 0xff000000u;
    for (int channel = 0; channel < 3; ++channel) {
        const double value = static_cast<double>(tile.rgb[channel][lane] * scale);
        const double clamped = value > 1 ? 1 : value > 0 ? value : 0;
        word |= static_cast<std::uint32_t>(std::lround(255 * clamped)) << (16 - 8 * channel);
    }
    return word;
}

TEST(Resolve, RoundsToTheNearestDisplayValueOnEveryInstructionSet) {
    std::mt19937 random(3);
    FilmTile tile;
    for (auto& channel : tile.rgb)
        for (float& value : channel) value = std::uniform_real_distribution<float>(-1, 6)(random);
    tile.rgb[0][0] = std::numeric_limits<float>::quiet_NaN();
    tile.rgb[1][0] = std::numeric_limits<float>::infinity();
    tile.rgb[2][0] = -std::numeric_limits<float>::infinity();
    for (const Kernels* kernels : available_kernels())
        for (const int columns : {8, 7, 4, 3, 1})
            for (const int rows : {8, 5, 4, 1}) {
                constexpr int stride = 11;
                std::vector<std::uint32_t> out(stride * 8, 0x12345678u);
                kernels->resolve_tile(tile, 0.25f, columns, rows, out.data(), stride);
                for (int lane = 0; lane < tile_pixels; ++lane) {
                    const int x = tile_pixel_x(lane), y = tile_pixel_y(lane);
                    const bool inside = x < columns && y < rows;
                    EXPECT_EQ(out[static_cast<std::size_t>(y * stride + x)],
                              inside ? display_word(tile, lane, 0.25f) : 0x12345678u)
                        << kernels->name << " lane " << lane;
                }
                for (int y = 0; y < 8; ++y)  // nothing beside the tile is touched
                    for (int x = 8; x < stride; ++x)
                        EXPECT_EQ(out[static_cast<std::size_t>(y * stride + x)], 0x12345678u);
            }
}

}  // namespace
}  // namespace raywalk
