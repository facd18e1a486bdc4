#include "app/walk/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace raywalk {
namespace {

constexpr double pi = 3.14159265358979323846;

double angle(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}
double pitch(const Camera& camera) { return std::asin(glm::dot(camera.direction, camera.north)); }

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(Walk, APressMovesHalfAUnitAlongTheViewOrAcross) {
    const Camera camera;  // at the origin, looking along -z
    expect_near(walk(camera, {.forward = 1}).eye, {0, 0, -0.5});
    expect_near(walk(camera, {.forward = -1}).eye, {0, 0, 0.5});
    expect_near(walk(camera, {.right = 1}).eye, {0.5, 0, 0});
    expect_near(walk(camera, {.right = -1}).eye, {-0.5, 0, 0});
}

TEST(Walk, ForwardFollowsAViewThatLooksUp) {
    const Camera up = walk(Camera{}, {.turn_up = 10});
    const Camera moved = walk(up, {.forward = 2});
    expect_near(moved.eye, up.direction);
    expect_near(walk(up, {.right = 2}).eye, {1, 0, 0});
}

TEST(Walk, APressTurnsThreePointSixDegrees) {
    const Camera camera;
    for (const WalkInput input :
         {WalkInput{.turn_right = 1}, WalkInput{.turn_right = -1}, WalkInput{.turn_up = 1}, WalkInput{.turn_up = -1}})
        EXPECT_NEAR(angle(camera.direction, walk(camera, input).direction), 0.02 * pi, 1e-12);
    EXPECT_GT(walk(camera, {.turn_right = 1}).direction.x, 0);
    EXPECT_GT(walk(camera, {.turn_up = 1}).direction.y, 0);
}

TEST(Walk, FiftyTurnsAreHalfACircleAndAHundredAWholeOne) {
    const Camera camera;
    expect_near(walk(camera, {.turn_right = 50}).direction, {0, 0, 1});
    expect_near(walk(camera, {.turn_right = 100}).direction, camera.direction);
}

TEST(Walk, PitchStopsAt89Degrees) {
    Camera camera;
    for (int i = 0; i < 100; ++i) camera = walk(camera, {.turn_up = 1});
    EXPECT_NEAR(pitch(camera), 89 * pi / 180, 1e-9);
    for (int i = 0; i < 200; ++i) camera = walk(camera, {.turn_up = -1});
    EXPECT_NEAR(pitch(camera), -89 * pi / 180, 1e-9);
    EXPECT_GT(camera.up.z, -2);  // a number
    expect_near(camera.right, {1, 0, 0}, 1e-9);
}

TEST(Walk, AViewThatOpensSteeperThanTheLimitTurnsWithoutAJump) {
    Viewer viewer{.width = 1,
                  .height = 1,
                  .viewport = {},
                  .center = {0, 0, 0},
                  .target = {0, 100, -1},
                  .up = {0, 1, 0},
                  .fovy_degrees = 45,
                  .depth_of_field = {},
                  .antialiasing = {}};
    const Camera steep = opening_camera(viewer, 1);
    EXPECT_GT(pitch(steep), walk_pitch_limit);
    EXPECT_NEAR(pitch(walk(steep, {.turn_right = 3})), pitch(steep), 1e-9);
    EXPECT_LE(pitch(walk(steep, {.turn_up = 3})), pitch(steep) + 1e-9);
    EXPECT_NEAR(pitch(walk(steep, {.turn_up = -1})), pitch(steep) - walk_turn, 1e-9);
}

TEST(Walk, NothingPressedChangesNoBit) {
    const Camera camera = walk(Camera{}, {.forward = 3.7, .turn_right = 2.2, .turn_up = 1.1});
    EXPECT_EQ(walk(camera, {}), camera);
    const Camera moved = walk(camera, {.forward = 1});
    EXPECT_EQ(moved.direction, camera.direction);
    EXPECT_EQ(moved.right, camera.right);
    EXPECT_EQ(walk(camera, {.turn_right = 1}).eye, camera.eye);
}

TEST(Walk, HeldKeysMakeTenPressesASecond) {
    EXPECT_EQ(held_for({.forward = true}, 1), (WalkInput{.forward = 10}));
    EXPECT_EQ(held_for({.back = true, .left = true}, 0.5), (WalkInput{.forward = -5, .right = -5}));
    EXPECT_EQ(held_for({.turn_up = true, .turn_left = true}, 0.1), (WalkInput{.turn_right = -1, .turn_up = 1}));
}

TEST(Walk, OppositeKeysCancel) {
    EXPECT_EQ(held_for({.forward = true,
                        .back = true,
                        .left = true,
                        .right = true,
                        .turn_up = true,
                        .turn_down = true,
                        .turn_left = true,
                        .turn_right = true},
                       3),
              WalkInput{});
    EXPECT_FALSE(HeldKeys{}.any());
    EXPECT_TRUE(HeldKeys{.turn_down = true}.any());
}

TEST(Walk, AHeldKeyLeadsToTheSamePlaceWhateverTheFrameRate) {
    for (const HeldKeys keys : {HeldKeys{.forward = true}, HeldKeys{.turn_up = true, .turn_left = true},
                                HeldKeys{.forward = true, .turn_right = true}}) {
        const auto after = [&](int frames) {
            Camera camera;
            for (int i = 0; i < frames; ++i) camera = walk(camera, held_for(keys, 1.0 / frames));
            return camera;
        };
        const Camera slow = after(15), fast = after(240);
        expect_near(slow.direction, fast.direction, 1e-9);
        expect_near(slow.eye, fast.eye, 0.01);  // a curve of 5 units, cut into straight steps
    }
}

TEST(Walk, NeverRollsAndNeverDrifts) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> presses(-3, 3);
    Viewer viewer{.width = 1,
                  .height = 1,
                  .viewport = {},
                  .center = {0, 0, 0},
                  .target = {1, 2, 3},
                  .up = {0.2, 0.1, 1},
                  .fovy_degrees = 45,
                  .depth_of_field = {},
                  .antialiasing = {}};
    Camera camera = opening_camera(viewer, 1);
    for (int i = 0; i < 100000; ++i) {
        camera = walk(camera, {.forward = presses(random),
                               .right = presses(random),
                               .turn_right = presses(random),
                               .turn_up = presses(random)});
        ASSERT_LT(std::abs(glm::dot(camera.right, camera.north)), 1e-12);
        ASSERT_LE(std::abs(pitch(camera)), walk_pitch_limit + 1e-9);
    }
    EXPECT_NEAR(glm::length(camera.direction), 1, 1e-14);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-14);
    EXPECT_NEAR(glm::length(camera.up), 1, 1e-12);
    EXPECT_NEAR(glm::dot(camera.direction, camera.right), 0, 1e-12);
    EXPECT_NEAR(glm::dot(camera.direction, camera.up), 0, 1e-12);
}

TEST(Walk, ThereAndBackEndsWhereItBegan) {
    const Camera camera = walk(Camera{}, {.turn_right = 1.5, .turn_up = 0.5});
    Camera walked = camera;
    for (int i = 0; i < 10; ++i) walked = walk(walked, {.turn_right = 1});
    for (int i = 0; i < 4; ++i) walked = walk(walked, {.forward = 1});
    for (int i = 0; i < 4; ++i) walked = walk(walked, {.forward = -1});
    for (int i = 0; i < 10; ++i) walked = walk(walked, {.turn_right = -1});
    expect_near(walked.eye, camera.eye);
    expect_near(walked.direction, camera.direction);
}

}  // namespace
}  // namespace raywalk
