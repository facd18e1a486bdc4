// Walking: input -> camera, a pure function of both (spec 2).
#pragma once

#include "tracer/picture/camera.h"

namespace raywalk {

inline constexpr double walk_step = 0.5;                                         // scene units a press
inline constexpr double walk_turn = 0.02 * 3.14159265358979323846;               // radians a press: 3.6 degrees
inline constexpr double walk_presses_per_second = 10;                            // of a key that is held
inline constexpr double walk_pitch_limit = 89.0 / 180 * 3.14159265358979323846;  // radians above or below level

// Presses of each kind, opposite keys already subtracted; fractions for held keys.
struct WalkInput {
    double forward = 0, right = 0;       // steps along the view, and along its horizontal axis
    double turn_right = 0, turn_up = 0;  // turns about `north`, and up or down
    WalkInput& operator+=(const WalkInput& other) {
        forward += other.forward, right += other.right;
        turn_right += other.turn_right, turn_up += other.turn_up;
        return *this;
    }
    friend bool operator==(const WalkInput&, const WalkInput&) = default;
};

// Keys that are down at the same time; opposite ones cancel.
struct HeldKeys {
    bool forward = false, back = false, left = false, right = false;
    bool turn_up = false, turn_down = false, turn_left = false, turn_right = false;
    [[nodiscard]] bool any() const {
        return forward || back || left || right || turn_up || turn_down || turn_left || turn_right;
    }
    friend bool operator==(const HeldKeys&, const HeldKeys&) = default;
};

// What keys held for `seconds` amount to.
WalkInput held_for(const HeldKeys& keys, double seconds);

// The camera after the input. Never rolls; a parameter that gets no input keeps its exact value.
Camera walk(const Camera& camera, const WalkInput& input);

}  // namespace raywalk
