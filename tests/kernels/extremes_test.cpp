// Eyes, lights, shapes and rays where numbers go wrong: never a NaN in a picture.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/kernels/scene.h"

namespace raywalk {
namespace {

// In the middle of spheres, on surfaces, and far away.
TEST(Shading, AwkwardEyesAndLightsGiveNoNan) {
    for (const glm::dvec3 eye : {glm::dvec3(0, 0, -5), glm::dvec3(0, -2, -5), glm::dvec3(0, 0, -4), glm::dvec3(0, 0, 0),
                                 glm::dvec3(1e6, 1e6, 1e6), glm::dvec3(0, -2 + 1e-7, 0)})
        for (const Material& material : materials) {
            Scene scene;
            scene.viewer = viewer_along_z(24, 24, 120);
            scene.viewer.center = eye;
            scene.viewer.target = eye + glm::dvec3(0, -0.1, -1);
            scene.spheres.push_back(
                {.texture = {material, GridTexture{3}}, .center = {0, 0, -5}, .radius = 1, .refraction_index = 1.5});
            scene.spheres.push_back(
                {.texture = surface({1, 1, 1}, material), .center = {0, 0, -5}, .radius = 1, .refraction_index = 1.3});
            scene.planes.push_back({.texture = {material, GridTexture{3}}, .normal = {0, 1, 0}, .offset = -2});
            scene.lights.push_back(white_light(eye));
            scene.lights.push_back(white_light({0, -2, -8}));
            scene.lights.push_back(white_light({0, 0, -5}));
            for (const bool blurred : {false, true}) {
                if (blurred)
                    scene.viewer.depth_of_field =
                        DepthOfField{.aperture_radius = 0.5, .focal_distance = 1e-3, .samples = 1};
                const Picture picture = picture_of(scene);
                EXPECT_EQ(picture.counts.dropped_samples, 0u) << material.name;
                EXPECT_EQ(picture.counts.camera, 24u * 24u);
            }
        }
}

// A sphere around the eye that single precision cannot tell from a point there.
TEST(Shading, SpheresSmallerThanTheRoundingOfTheirPlaceGiveNoNan) {
    for (const Material& material : materials) {
        Scene scene;
        scene.viewer = viewer_along_z(8, 8, 60);
        scene.viewer.center = {-4.21, -3.64, 1e6};
        scene.viewer.target = {0, 0, 0};
        scene.spheres.push_back({.texture = surface({1, 1, 1}, material),
                                 .center = scene.viewer.center,
                                 .radius = 4.7e-7,
                                 .refraction_index = 1.333});
        scene.spheres.push_back(
            {.texture = surface({1, 1, 1}, material), .center = {0, 0, 0}, .radius = 1e5, .refraction_index = 1.5});
        scene.lights.push_back(white_light(scene.viewer.center));
        const Picture picture = picture_of(scene);
        EXPECT_EQ(picture.counts.dropped_samples, 0u) << material.name;
    }
}

// Mirrors that meet at a hair's angle send rays as far away as numbers go.
TEST(Shading, RaysThatStartFarBeyondTheSceneGiveNoNan) {
    for (const double tilt : {1e-4, 1e-7, 1e-8, 1e-9, 1e-12, 0.0}) {
        Scene scene;
        scene.viewer = viewer_along_z(24, 24, 1e-5);
        for (const double offset : {-1.0, 1.0})
            scene.planes.push_back({.texture = {perfect_mirror, GridTexture{3}},
                                    .normal = glm::normalize(glm::dvec3(0, 1, offset * tilt)),
                                    .offset = offset * 1e12});
        scene.spheres.push_back({.texture = surface({1, 1, 1}, materials[4]), .center = {0, 0, -5}, .radius = 1e-6});
        scene.lights.push_back(white_light({0, 1, 0}));
        const Picture picture = picture_of(scene);
        EXPECT_EQ(picture.counts.dropped_samples, 0u) << tilt;
        EXPECT_EQ(picture.counts.camera, 24u * 24u);
    }
}

}  // namespace
}  // namespace raywalk
