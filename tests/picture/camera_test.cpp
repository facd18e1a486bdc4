#include "tracer/picture/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace raywalk {
namespace {

Viewer viewer_800_600() {
    return {.width = 800,
            .height = 600,
            .viewport = {},
            .center = {1, 2, 3},
            .target = {1, 2, -7},
            .up = {0, 3, 0},
            .fovy_degrees = 60,
            .depth_of_field = {},
            .antialiasing = {}};
}

TEST(Camera, StandsAtTheCenterAndLooksAtTheTarget) {
    const Camera camera = opening_camera(viewer_800_600(), 4.0 / 3);
    EXPECT_EQ(camera.eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(camera.direction, glm::dvec3(0, 0, -1));
    EXPECT_EQ(camera.right, glm::dvec3(1, 0, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(camera.north, glm::dvec3(0, 1, 0));
}

TEST(Camera, AxesAreOrthonormalAndRightIsDirectionCrossUp) {
    Viewer viewer = viewer_800_600();
    viewer.target = {4, -3, 2};
    viewer.up = {0.3, 1, -0.4};
    const Camera camera = opening_camera(viewer, 4.0 / 3);
    EXPECT_NEAR(glm::length(camera.direction), 1, 1e-15);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-15);
    EXPECT_NEAR(glm::length(camera.up), 1, 1e-15);
    EXPECT_NEAR(glm::dot(camera.direction, camera.right), 0, 1e-15);
    EXPECT_NEAR(glm::dot(camera.direction, camera.up), 0, 1e-15);
    EXPECT_GT(glm::dot(camera.up, glm::normalize(viewer.up)), 0);
    EXPECT_NEAR(glm::length(glm::cross(camera.direction, camera.north) /
                                glm::length(glm::cross(camera.direction, camera.north)) -
                            camera.right),
                0, 1e-15);
}

TEST(Camera, HalfHeightIsTheTangentOfHalfTheFieldOfView) {
    EXPECT_NEAR(opening_camera(viewer_800_600(), 4.0 / 3).half_height, 1 / std::sqrt(3.0), 1e-15);
}

TEST(Camera, OpensInPerspectiveWithoutAViewportAndOrthographicWithOne) {
    Viewer viewer = viewer_800_600();
    EXPECT_EQ(opening_camera(viewer, 4.0 / 3).projection, Projection::perspective);
    viewer.viewport = {12, 9};
    const Camera camera = opening_camera(viewer, 4.0 / 3);
    EXPECT_EQ(camera.projection, Projection::orthographic);
    EXPECT_EQ(camera.orthographic_half, glm::dvec2(6, 4.5));
}

TEST(Camera, TheCommandLineChoosesTheProjection) {
    Viewer viewer = viewer_800_600();
    EXPECT_EQ(opening_camera(viewer, 4.0 / 3, Projection::orthographic).projection, Projection::orthographic);
    viewer.viewport = {12, 9};
    EXPECT_EQ(opening_camera(viewer, 4.0 / 3, Projection::perspective).projection, Projection::perspective);
}

TEST(Camera, WithoutAViewportTheOrthographicPictureKeepsItsSizeAtTheTarget) {
    const Camera camera = opening_camera(viewer_800_600(), 4.0 / 3);
    const double distance = 10;  // to the target
    EXPECT_NEAR(camera.orthographic_half.y, camera.half_height * distance, 1e-12);
    EXPECT_NEAR(camera.orthographic_half.x, camera.half_height * distance * 4 / 3, 1e-12);
}

TEST(Camera, AnotherPictureShapeKeepsTheViewportsHeight) {
    Viewer viewer = viewer_800_600();
    viewer.viewport = {16, 9};
    const Camera camera = opening_camera(viewer, 2 * 4.0 / 3);
    EXPECT_NEAR(camera.orthographic_half.x, 16, 1e-12);
    EXPECT_EQ(camera.orthographic_half.y, 4.5);
    EXPECT_EQ(reshaped(camera, 1.7, 1.7), camera);
}

TEST(Camera, TheProjectionToggledTwiceIsTheSameCamera) {
    const Camera camera = opening_camera(viewer_800_600(), 4.0 / 3);
    const Camera toggled = toggled_projection(camera);
    EXPECT_EQ(toggled.projection, Projection::orthographic);
    EXPECT_NE(toggled, camera);
    EXPECT_EQ(toggled_projection(toggled), camera);
}

TEST(Camera, DepthOfFieldSetsApertureAndFocus) {
    Viewer viewer = viewer_800_600();
    EXPECT_EQ(opening_camera(viewer, 1).aperture_radius, 0);
    viewer.depth_of_field = DepthOfField{.aperture_radius = 0.2, .focal_distance = 15, .samples = 20};
    const Camera camera = opening_camera(viewer, 1);
    EXPECT_EQ(camera.aperture_radius, 0.2);
    EXPECT_EQ(camera.focal_distance, 15);
}

}  // namespace
}  // namespace raywalk
