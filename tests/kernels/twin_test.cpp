// Tiles against a renderer of a hundred plain lines, on random scenes of everything there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "tests/kernels/scene.h"
#include "tests/oracle/shading_naive.h"
#include "tests/support/repetitions.h"

namespace raywalk {
namespace {

Texture random_texture(std::mt19937& random, bool grid_allowed) {
    std::uniform_real_distribution<double> unit(0, 1);
    Texture texture;
    texture.material = materials[random() % std::size(materials)];
    if (unit(random) < 0.3)  // nothing in the table does everything at once
        texture.material = {"all", 0.3, 0.2, static_cast<int>(random() % 9), 0.4, 0.5};
    if (grid_allowed && unit(random) < 0.4)
        texture.pattern = GridTexture{1 + static_cast<int>(random() % 20)};
    else
        texture.pattern = PureTexture{{unit(random), unit(random), unit(random)}};
    return texture;
}

Scene random_scene(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto between = [&](double a, double b) { return a + (b - a) * unit(random); };
    const auto in_room = [&] { return glm::dvec3(between(-4, 4), between(-3, 3), between(-14, -5)); };
    Scene scene;
    scene.viewer = viewer_along_z(60, 44, 55);
    scene.viewer.center = {0.3, 0.2, 0.5};
    scene.viewer.target = {between(-1, 1), between(-1, 1), -9};
    const int axes[] = {0, 1, 1, 2};
    for (const int axis : axes) {
        Plane plane{.texture = random_texture(random, true), .normal = glm::dvec3(0), .offset = 0};
        plane.normal[axis] = unit(random) < 0.5 ? -1 : 1;
        plane.offset = plane.normal[axis] * (axis == 2 ? -18 : between(4, 7) * (unit(random) < 0.5 ? -1 : 1));
        if (unit(random) < 0.6) scene.planes.push_back(plane);
    }
    for (int i = 0; i < 6; ++i)
        scene.spheres.push_back({.texture = random_texture(random, true),
                                 .center = in_room(),
                                 .radius = between(0.3, 1.5),
                                 .refraction_index = between(0.7, 1.8)});
    for (int i = 0; i < 5; ++i)
        scene.faces.push_back(
            {.texture = random_texture(random, false), .a = in_room(), .b = in_room(), .c = in_room()});
    for (int i = 0; i < 2; ++i)
        scene.lights.push_back({.origin = in_room(),
                                .color = {unit(random), unit(random), unit(random)},
                                .intensity = between(0.2, 1.5),
                                .area = {}});
    scene.lights.push_back(
        {.origin = {0, 3, -2}, .color = glm::dvec3(1), .intensity = 0.7, .area = AreaSpread{.n = 3, .radius = 0.4}});
    return scene;
}

Picture naive_picture(const Scene& scene, const Camera& camera) {
    const int width = scene.viewer.width, height = scene.viewer.height;
    Picture picture{.width = width, .height = height, .pixels = {}, .counts = {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture.pixels.emplace_back(
                naive_radiance(scene, camera.eye, direction_through(camera, width, height, x + 0.5, y + 0.5)));
    return picture;
}

// Pixels where a ray meets an edge within rounding differ; so do those behind many bounces off small spheres, each of
// which magnifies an error of the direction some ten times.
TEST(ShadingTwin, RandomScenesLookAsTheFormulasSay) {
    double worst = 0;
    for (std::uint32_t seed = 0; seed < test::repetitions(24); ++seed) {
        const Scene scene = random_scene(seed);
        const Camera camera = opening_camera(scene.viewer, 60.0 / 44);
        const Picture naive = naive_picture(scene, camera);
        for (const Accelerator accelerator : {Accelerator::kdtree, Accelerator::bvh}) {
            const Picture ours = picture_of(compiled(scene, accelerator), camera, 60, 44);
            const double share = share_of_differing(naive, ours, 1e-4);
            worst = std::max(worst, share);
            EXPECT_LE(share, 0.02) << "seed " << seed;
            EXPECT_EQ(ours.counts.dropped_samples, 0u);
        }
    }
    RecordProperty("worst_share", std::to_string(worst));
}

}  // namespace
}  // namespace raywalk
