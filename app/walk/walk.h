// Walking: input -> camera, a pure function of both (spec 2); keys -> exposure.
#pragma once

#include <span>

#include "tracer/picture/camera.h"

namespace raywalk {

inline constexpr double walk_step = 0.5;                                         // scene units a press
inline constexpr double walk_turn = 0.02 * 3.14159265358979323846;               // radians a press: 3.6 degrees
inline constexpr double walk_presses_per_second = 10;                            // of a key that is held
inline constexpr double walk_pitch_limit = 89.0 / 180 * 3.14159265358979323846;  // radians above or below level

enum class WalkKey : char {
    forward = 'w',
    back = 's',
    left = 'a',
    right = 'd',
    turn_up = 'U',
    turn_down = 'D',
    turn_left = 'L',
    turn_right = 'R',
    toggle = 't',
    darker = '[',
    brighter = ']',
    quit = 'q',
};

// Presses of each kind, opposite keys already subtracted; fractions for held keys.
struct WalkInput {
    double forward = 0, right = 0;       // steps along the view, and along its horizontal axis
    double turn_right = 0, turn_up = 0;  // turns about `north`, and up or down
};

// The camera after the input. Never rolls; a parameter that gets no input keeps its exact value.
Camera walk(const Camera& camera, const WalkInput& input);

// The camera after one press. Keys of the exposure and `quit` change nothing.
Camera pressed(const Camera& camera, WalkKey key);
// The camera after the presses up to the first `quit`.
Camera pressed(const Camera& camera, std::span<const WalkKey> keys);

// Presses of `brighter` less those of `darker`: of one key, and up to the first `quit`.
int exposure_presses(WalkKey key);
int exposure_presses(std::span<const WalkKey> keys);
// What so many presses multiply the exposure by. Of the sum of them, so that there and back is 1. Above 0, finite.
float exposure_factor(int presses);

}  // namespace raywalk
