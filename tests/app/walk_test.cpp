#include "app/walk/walk.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
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

TEST(Walk, AHeldKeyLeadsToTheSamePlaceWhateverTheFrameRate) {
    for (const WalkInput second : {WalkInput{.forward = 10}, WalkInput{.turn_right = -10, .turn_up = 10},
                                   WalkInput{.forward = 10, .turn_right = 10}}) {
        const auto after = [&](int frames) {
            const WalkInput frame = {.forward = second.forward / frames,
                                     .right = second.right / frames,
                                     .turn_right = second.turn_right / frames,
                                     .turn_up = second.turn_up / frames};
            Camera camera;
            for (int i = 0; i < frames; ++i) camera = walk(camera, frame);
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

TEST(Walk, EachKeyDoesWhatTheWindowsKeyDoes) {
    using enum WalkKey;
    const Camera camera;
    EXPECT_EQ(pressed(camera, forward).eye, glm::dvec3(0, 0, -0.5));
    EXPECT_EQ(pressed(camera, back).eye, glm::dvec3(0, 0, 0.5));
    EXPECT_EQ(pressed(camera, left).eye, glm::dvec3(-0.5, 0, 0));
    EXPECT_EQ(pressed(camera, right).eye, glm::dvec3(0.5, 0, 0));
    EXPECT_GT(pressed(camera, turn_up).direction.y, 0);
    EXPECT_LT(pressed(camera, turn_down).direction.y, 0);
    EXPECT_LT(pressed(camera, turn_left).direction.x, 0);
    EXPECT_GT(pressed(camera, turn_right).direction.x, 0);
    EXPECT_EQ(pressed(camera, toggle).projection, Projection::orthographic);
    EXPECT_EQ(pressed(camera, std::array{toggle, toggle}), camera);
    for (const WalkKey key : {darker, brighter, quit}) EXPECT_EQ(pressed(camera, key), camera);
}

TEST(Walk, PressesEndAtTheFirstQuit) {
    using enum WalkKey;
    const Camera camera;
    EXPECT_EQ(pressed(camera, std::array{forward, forward, quit, turn_left}),
              pressed(camera, std::array{forward, forward}));
    EXPECT_EQ(pressed(camera, std::array{quit}), camera);
    EXPECT_EQ(exposure_presses(std::array{brighter, brighter, quit, brighter}), 2);
}

TEST(Walk, PressesOfTheExposureAddUpAndMultiply) {
    using enum WalkKey;
    const auto factor = [](std::initializer_list<WalkKey> keys) { return exposure_factor(exposure_presses(keys)); };
    EXPECT_EQ(factor({}), 1);
    EXPECT_EQ(factor({forward, turn_left, toggle}), 1);
    EXPECT_EQ(factor({brighter}), 1.25f);
    EXPECT_EQ(factor({brighter, forward, brighter, brighter}), 1.25f * 1.25f * 1.25f);
    EXPECT_EQ(factor({darker}), 0.8f);
    EXPECT_EQ(factor({darker, darker, darker, brighter, brighter, brighter}), 1);
    for (const int many : {300, 1'000'000, -300, -1'000'000}) {
        EXPECT_TRUE(std::isnormal(exposure_factor(many))) << many;
        EXPECT_GT(exposure_factor(many), 0) << many;
    }
}

}  // namespace
}  // namespace raywalk
