// Keys to camera by time (spec 2), without a window.
#include "app/walk/input.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "app/display/window.h"
#include "app/walk/walk.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace raywalk {
namespace {

Camera start() { return Camera{.eye = {1, 2, 3}}; }

double steps_forward(const Camera& camera) { return glm::dot(camera.eye - start().eye, start().direction) / walk_step; }

TEST(Input, AShortPressIsOneStepOfTheScriptBitForBit) {
    for (const WalkKey key : {WalkKey::forward, WalkKey::back, WalkKey::left, WalkKey::right, WalkKey::turn_up,
                              WalkKey::turn_down, WalkKey::turn_left, WalkKey::turn_right, WalkKey::toggle}) {
        Input input;
        input.press(key, 10);
        input.release(key, 10.05);
        EXPECT_EQ(input.advance(start(), 12), pressed(start(), key)) << static_cast<char>(key);
        EXPECT_FALSE(input.moving());
    }
}

TEST(Input, AShortPressThatFramesCutIntoPiecesIsStillOneStep) {
    Input input;
    input.press(WalkKey::forward, 10);
    Camera camera = input.advance(start(), 10.001);
    EXPECT_EQ(camera, pressed(start(), WalkKey::forward)) << "at once";
    for (const double now : {10.02, 10.04, 10.06}) camera = input.advance(camera, now);
    input.release(WalkKey::forward, 10.07);
    EXPECT_EQ(input.advance(camera, 11), pressed(start(), WalkKey::forward));
}

TEST(Input, PressesBetweenTwoFramesAllCountInTheirOrder) {
    Input input;
    std::vector<WalkKey> script;
    double now = 5;
    for (const WalkKey key : {WalkKey::forward, WalkKey::turn_left, WalkKey::forward, WalkKey::forward,
                              WalkKey::turn_up, WalkKey::right, WalkKey::toggle}) {
        input.press(key, now += 0.001);
        input.release(key, now += 0.001);
        script.push_back(key);
    }
    EXPECT_EQ(input.advance(start(), 5.02), pressed(start(), script));
}

TEST(Input, AHeldKeyMovesTenStepsASecondHoweverTheTimeIsCut) {
    for (const double frame : {0.001, 0.013, 0.09, 0.4, 2.0}) {
        Input input;
        input.press(WalkKey::forward, 0);
        Camera camera = start();
        for (double now = 0; now < 2; now += frame) camera = input.advance(camera, now);
        input.release(WalkKey::forward, 2);
        camera = input.advance(camera, 3);
        EXPECT_NEAR(steps_forward(camera), 2 * walk_presses_per_second, 1e-9) << "frames of " << frame << " s";
    }
}

TEST(Input, HeldKeysMakeTenPressesASecond) {
    struct Case {
        std::vector<WalkKey> keys;
        double seconds;
        WalkInput sum;
    };
    using enum WalkKey;
    for (const auto& [keys, seconds, sum] :
         {Case{{forward}, 1, {.forward = 10}}, Case{{back, left}, 0.5, {.forward = -5, .right = -5}},
          Case{{right}, 0.7, {.right = 7}}, Case{{turn_up, turn_left}, 0.1, {.turn_right = -1, .turn_up = 1}},
          Case{{turn_down, turn_right}, 0.5, {.turn_right = 5, .turn_up = -5}}}) {
        Input input;
        for (const WalkKey key : keys) input.press(key, 0);
        const Camera camera = input.advance(start(), seconds), expected = walk(start(), sum);
        EXPECT_LT(glm::length(camera.eye - expected.eye), 1e-9) << static_cast<char>(keys.front());
        EXPECT_LT(glm::length(camera.direction - expected.direction), 1e-9) << static_cast<char>(keys.front());
    }
}

TEST(Input, ATimeThatTheWalkStoodStillMovesNothing) {
    Input input;
    input.press(WalkKey::forward, 0);
    Camera camera = input.advance(start(), 1);
    const double before = steps_forward(camera);
    input.skip(2.9);
    camera = input.advance(camera, 3);
    EXPECT_NEAR(steps_forward(camera) - before, 0.1 * walk_presses_per_second, 1e-9);
    input.skip(2.9);  // seen already
    EXPECT_NEAR(steps_forward(input.advance(camera, 3.1)) - before, 0.2 * walk_presses_per_second, 1e-9);
}

TEST(Input, OppositeKeysCancelWhileBothAreDown) {
    Input input;
    input.press(WalkKey::forward, 0);
    input.press(WalkKey::back, 1);  // ten steps until here, then nothing
    EXPECT_NEAR(steps_forward(input.advance(start(), 1)), 10, 1e-9);
    EXPECT_FALSE(input.moving());
    const Camera stopped = input.advance(start(), 1.5);
    EXPECT_EQ(stopped, start());
    input.release(WalkKey::back, 2);
    EXPECT_NEAR(steps_forward(input.advance(start(), 2.5)), 5, 1e-9) << "and goes on";
    EXPECT_TRUE(input.moving());
}

TEST(Input, EveryPairOfOppositeKeysCancels) {
    using enum WalkKey;
    Input input;
    EXPECT_FALSE(input.moving());
    for (const WalkKey key : {forward, back, left, right, turn_up, turn_down, turn_left, turn_right}) {
        Input alone;
        alone.press(key, 0);
        alone.advance(start(), 0);
        EXPECT_TRUE(alone.moving()) << static_cast<char>(key);
        input.press(key, 0);
    }
    const Camera camera = input.advance(start(), 0);
    EXPECT_FALSE(input.moving());
    EXPECT_EQ(input.advance(camera, 3), camera);
}

TEST(Input, TheOppositeKeyGoesOnWhenTheFirstIsReleased) {
    Input input;
    input.press(WalkKey::left, 0);
    input.release(WalkKey::left, 1);
    Camera camera = input.advance(start(), 0.5);
    camera = start();
    input.press(WalkKey::left, 1);
    input.press(WalkKey::right, 1);
    input.release(WalkKey::left, 2);
    camera = input.advance(camera, 3);
    EXPECT_NEAR((camera.eye.x - start().eye.x) / walk_step, 10 - 1, 1e-9)
        << "a second to the right, a step to the left";
}

TEST(Input, LosingTheFocusReleasesEveryKey) {
    Input input;
    input.press(WalkKey::forward, 0);
    input.press(WalkKey::turn_left, 0);
    input.release_all(0.5);
    const Camera camera = input.advance(start(), 0.5);
    EXPECT_FALSE(input.moving());
    EXPECT_EQ(input.advance(camera, 100), camera);
}

TEST(Input, PressesOfTheExposureAreCounted) {
    Input input;
    Camera camera = start();
    for (const WalkKey key : {WalkKey::brighter, WalkKey::brighter, WalkKey::darker, WalkKey::brighter}) {
        input.press(key, 1);
        EXPECT_FALSE(input.moving());
        camera = input.advance(camera, 5);  // held for long: one press still
        input.release(key, 5);
    }
    EXPECT_EQ(camera, start());
    EXPECT_EQ(input.exposure_presses(), 2);
    input.press(WalkKey::darker, 6);
    EXPECT_EQ(input.exposure_presses(), 2) << "no advance has seen it";
    input.advance(camera, 6);
    EXPECT_EQ(input.exposure_presses(), 1);
}

TEST(Input, NothingMovesAfterQuit) {
    Input input;
    input.press(WalkKey::quit, 1);
    input.press(WalkKey::forward, 2);
    input.press(WalkKey::brighter, 2);
    EXPECT_EQ(input.advance(start(), 2.01), start());
    EXPECT_EQ(input.exposure_presses(), 0);
    EXPECT_TRUE(input.quit());
}

TEST(Keyboard, WalkingGoesByPlaceAndQuitByLabel) {
    EXPECT_EQ(walk_key(GLFW_KEY_W, {"z"}), WalkKey::forward) << "AZERTY";
    EXPECT_EQ(walk_key(GLFW_KEY_A, {"q"}), WalkKey::left) << "AZERTY: left of S";
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"a"}), std::nullopt) << "AZERTY: the key labelled A does not quit";
    EXPECT_EQ(letter_of(GLFW_KEY_A, {"q"}), 'q') << "AZERTY: with Ctrl it does";
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"q"}), WalkKey::quit);
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"Q"}), WalkKey::quit);
    EXPECT_EQ(walk_key(GLFW_KEY_X, {"q"}), WalkKey::quit) << "Dvorak: the key labelled Q";
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"'"}), std::nullopt) << "Dvorak: in the place of Q";
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {""}), WalkKey::quit) << "no label known";
    EXPECT_EQ(walk_key(GLFW_KEY_T, {"t"}), WalkKey::toggle);
    EXPECT_EQ(walk_key(GLFW_KEY_T, {"y"}), std::nullopt);
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"\u0439", false}), WalkKey::quit) << "Cyrillic: no Latin letter anywhere";
    EXPECT_EQ(walk_key(GLFW_KEY_Q, {"/", false}), WalkKey::quit) << "Hebrew";
    EXPECT_EQ(walk_key(GLFW_KEY_T, {"\u03c4", false}), WalkKey::toggle) << "Greek";
    EXPECT_EQ(walk_key(GLFW_KEY_SLASH, {"q", false}), std::nullopt);
    EXPECT_EQ(walk_key(GLFW_KEY_LEFT_BRACKET, {"["}), WalkKey::darker);
    EXPECT_EQ(walk_key(GLFW_KEY_RIGHT_BRACKET, {"+"}), WalkKey::brighter) << "QWERTZ: by place";
    EXPECT_EQ(walk_key(GLFW_KEY_RIGHT_BRACKET, {"\u044a", false}), WalkKey::brighter) << "Cyrillic";
    EXPECT_EQ(walk_key(GLFW_KEY_LEFT_BRACKET, {"q"}), WalkKey::quit) << "Turkish F: the key labelled Q";
    EXPECT_EQ(walk_key(GLFW_KEY_ESCAPE, {""}), WalkKey::quit);
    EXPECT_EQ(walk_key(GLFW_KEY_UP, {""}), WalkKey::turn_up);
}

}  // namespace
}  // namespace raywalk
