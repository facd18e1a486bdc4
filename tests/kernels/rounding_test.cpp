// Pictures that rounding would spoil: shapes much larger than what is seen of them, and scenes far from zero.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "tests/kernels/scene.h"

namespace raywalk {
namespace {

// A viewer at `height` above the origin that looks slightly up and along x, and a light ten times as high.
Scene seen_from(double height) {
    Scene scene;
    scene.viewer = viewer_along_z(80, 60, 60);
    scene.viewer.center = {0, height, 0};
    scene.viewer.target = {3 * height, 0, height};
    scene.lights.push_back(white_light({0.3 * height, 10 * height, 0.2 * height}));
    return scene;
}

// Pixels that are black between two that are not.
int black_specks(const Picture& picture) {
    int specks = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 1; x + 1 < picture.width; ++x)
            specks += picture.at(x, y).x == 0 && picture.at(x - 1, y).x > 0 && picture.at(x + 1, y).x > 0;
    return specks;
}

int lit_pixels(const Picture& picture) {
    return static_cast<int>(std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                          [](const glm::vec3& pixel) { return pixel.x > 0; }));
}

void expect_no_specks(const Scene& scene) {
    const CompiledScene compiled_scene = compiled(scene, Accelerator::bvh);
    const Camera camera = opening_camera(scene.viewer, 80.0 / 60);
    for (const Kernels* kernels : available_kernels()) {
        const Picture picture = picture_of(compiled_scene, camera, 80, 60, {.kernels = kernels->name});
        EXPECT_EQ(black_specks(picture), 0) << kernels->name;
        EXPECT_GT(lit_pixels(picture), 500) << kernels->name;
    }
}

TEST(Rounding, LeavesNoSpecksOnBallsOfAnySize) {
    for (double radius = 1e-3; radius < 2e6; radius *= 10)
        for (const double part : {1e-6, 1e-4, 1e-2}) {
            SCOPED_TRACE("a ball of radius " + std::to_string(radius) + " seen from " + std::to_string(part) +
                         " of it");
            Scene scene = seen_from(radius * part);
            scene.spheres.push_back(
                {.texture = surface({1, 1, 1}, matte), .center = {0, -radius, 0}, .radius = radius});
            if (radius * part >= 1e-6 && radius * part <= 100) expect_no_specks(scene);  // (light fades)
        }
}

TEST(Rounding, LeavesNoSpecksOnTrianglesOfAnySize) {
    for (double size = 10; size < 2e6; size *= 10)
        for (const double height : {0.02, 0.2, 2.0}) {
            SCOPED_TRACE("a triangle of " + std::to_string(size) + " seen from " + std::to_string(height));
            if (size < height * 50) continue;
            Scene scene = seen_from(height);
            const auto corner = [&](double x, double z) { return glm::dvec3(x, 0.1 * x + 0.05 * z, z) * size; };
            scene.faces.push_back({.texture = surface({1, 1, 1}, matte),
                                   .a = corner(-1, -1),
                                   .b = corner(1.1, -0.9),
                                   .c = corner(0.1, 1.3)});
            expect_no_specks(scene);
        }
}

// A mirror ball, a matte ball and glass on a floor of squares.
Scene still_life() {
    Scene scene;
    scene.viewer = viewer_along_z(80, 60, 45);
    scene.viewer.center = {0, 2, 7};
    scene.viewer.target = {0, 1, 0};
    scene.lights.push_back(white_light({3, 6, 4}));
    Texture squares = surface({1, 1, 1}, materials[0]);
    squares.pattern = GridTexture{1};
    scene.planes.push_back({.texture = squares, .normal = {0, 1, 0}, .offset = 0});
    scene.spheres.push_back({.texture = surface({1, 0, 0}, materials[4]), .center = {-1.2, 1, 0}, .radius = 1});
    scene.spheres.push_back({.texture = surface({0, 0, 0}, perfect_mirror), .center = {1.2, 1, 0}, .radius = 1});
    scene.faces.push_back({.texture = surface({0, 0, 1}, matte), .a = {-3, 0, -2}, .b = {3, 0, -2}, .c = {0, 3, -2}});
    return scene;
}

Scene moved_by(Scene scene, const glm::dvec3& d) {
    scene.viewer.center += d;
    scene.viewer.target += d;
    for (Light& light : scene.lights) light.origin += d;
    for (Plane& plane : scene.planes) plane.offset += glm::dot(plane.normal, d);
    for (Sphere& sphere : scene.spheres) sphere.center += d;
    for (Face& face : scene.faces) face.a += d, face.b += d, face.c += d;
    return scene;
}

TEST(Rounding, AScenesPlaceDoesNotChangeItsPicture) {
    const Picture here = picture_of(still_life());
    for (const glm::dvec3& place : {glm::dvec3(1e6, 0, 1e6), glm::dvec3(-4e5, 2e7, 4649776), glm::dvec3(0, 0, 3e9)}) {
        const Picture there = picture_of(moved_by(still_life(), place));
        EXPECT_LT(share_of_differing(here, there, 1e-3), 0.005) << place.x << ' ' << place.y << ' ' << place.z;
        EXPECT_GT(lit_pixels(there), 1000);
    }
}

TEST(Rounding, ScenesNearZeroKeepTheirZero) {
    EXPECT_EQ(compiled(still_life()).origin, glm::dvec3(0));
    EXPECT_EQ(compiled(moved_by(still_life(), {20, 0, 100})).origin, glm::dvec3(0));
    EXPECT_NE(compiled(moved_by(still_life(), {0, 0, 1e5})).origin, glm::dvec3(0));
}

// A ball of 8 x 6 facets in an OBJ file of its own.
class FacetedBall : public testing::Test {
  protected:
    void TearDown() override { std::filesystem::remove(file_); }
    // `normal_sign` 0: without vn. `clockwise`: faces wound the other way.
    Scene ball(bool clockwise, int normal_sign) {
        std::ofstream obj(file_);
        constexpr int around = 8, rings = 6;
        for (int j = 0; j <= rings; ++j)
            for (int i = 0; i < around; ++i) {
                const double a = 2 * std::numbers::pi * i / around, b = std::numbers::pi * j / rings;
                const glm::dvec3 p(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
                obj << "v " << p.x << ' ' << p.y << ' ' << p.z << "\nvn " << p.x * normal_sign << ' '
                    << p.y * normal_sign << ' ' << p.z * normal_sign << '\n';
            }
        const auto corner = [&](int i, int j) {
            const std::string index = std::to_string(1 + j * around + i % around);
            return normal_sign == 0 ? index : index + "//" + index;
        };
        const auto face = [&](const std::string& a, const std::string& b, const std::string& c) {
            obj << "f " << a << ' ' << (clockwise ? c : b) << ' ' << (clockwise ? b : c) << '\n';
        };
        for (int j = 0; j < rings; ++j)
            for (int i = 0; i < around; ++i) {
                if (j > 0) face(corner(i, j), corner(i + 1, j), corner(i, j + 1));
                if (j + 1 < rings) face(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
            }
        obj.close();
        Scene scene;
        scene.viewer = viewer_along_z(80, 60, 30);
        scene.meshes.push_back({.texture = surface({1, 1, 1}, matte),
                                .file = file_,
                                .where = {},
                                .center = {0, 0, -5},
                                .radius = 1,
                                .smooth = true});
        scene.lights.push_back(white_light(light_));
        return scene;
    }
    // So that the facets in the middle of the picture face away from it, and their normals towards it on one side.
    const glm::dvec3 light_ = {5.6, 1, -3};
    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("raywalk_ball_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".obj");
};

// Where light falls on the ball that the normals mean, the facets show it: the terminator is a line, no stair of
// facets.
TEST_F(FacetedBall, IsLitWhereItsNormalsFaceTheLight) {
    const Scene scene = ball(false, 1);
    const Picture picture = picture_of(scene);
    const Camera camera = opening_camera(scene.viewer, 80.0 / 60);
    int lit = 0;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x) {
            const glm::dvec3 d = direction_through(camera, 80, 60, x + 0.5, y + 0.5);
            const double b = glm::dot(d, glm::dvec3(0, 0, -5)), c = 25 - 0.8 * 0.8;
            if (b * b < c) continue;  // well inside the silhouette
            const glm::dvec3 p = d * (b - std::sqrt(b * b - c)), n = glm::normalize(p - glm::dvec3(0, 0, -5));
            const double facing = glm::dot(n, glm::normalize(light_ - p));
            if (facing < 0.12) continue;
            EXPECT_GT(picture.at(x, y).x, 0) << x << ", " << y;
            ++lit;
        }
    EXPECT_GT(lit, 200);
}

TEST_F(FacetedBall, LooksTheSameWhicheverWayItIsWound) {
    const Picture right = picture_of(ball(false, 1));
    EXPECT_LT(share_of_differing(right, picture_of(ball(true, 1)), 1e-4), 0.002);
    EXPECT_LT(share_of_differing(right, picture_of(ball(true, -1)), 1e-4), 0.002);
    EXPECT_LT(share_of_differing(right, picture_of(ball(false, -1)), 1e-4), 0.002);
    const Picture without = picture_of(ball(false, 0));
    EXPECT_LT(share_of_differing(without, picture_of(ball(true, 0)), 1e-4), 0.002);
    EXPECT_GT(lit_pixels(without), 400);
}

}  // namespace
}  // namespace raywalk
