#include "app/walk/walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace raywalk {

namespace {

// Turns the view about north and then up, through yaw and pitch, so that the axes are made anew each time: errors do
// not add up and the horizon stays level.
Camera turned(const Camera& camera, double yaw, double pitch_change) {
    if (yaw == 0 && pitch_change == 0) return camera;
    const glm::dvec3 level = glm::normalize(glm::cross(camera.north, camera.right));  // the view, pitch taken out
    const glm::dvec3 side = glm::cross(level, camera.north);
    const double pitch = std::atan2(glm::dot(camera.direction, camera.north), glm::dot(camera.direction, level));
    // A scene may open steeper than the walk turns: such a view can come back, not go further.
    const double limit = std::max(walk_pitch_limit, std::abs(pitch));
    const double new_pitch = std::clamp(pitch + pitch_change, -limit, limit);

    const glm::dvec3 heading = level * std::cos(yaw) + side * std::sin(yaw);
    Camera other = camera;
    other.direction = glm::normalize(heading * std::cos(new_pitch) + camera.north * std::sin(new_pitch));
    other.right = glm::normalize(glm::cross(heading, camera.north));
    other.up = glm::cross(other.right, other.direction);
    return other;
}

}  // namespace

WalkInput held_for(const HeldKeys& keys, double seconds) {
    const double presses = seconds * walk_presses_per_second;
    const auto balance = [&](bool plus, bool minus) { return presses * (int{plus} - int{minus}); };
    return {.forward = balance(keys.forward, keys.back),
            .right = balance(keys.right, keys.left),
            .turn_right = balance(keys.turn_right, keys.turn_left),
            .turn_up = balance(keys.turn_up, keys.turn_down)};
}

Camera walk(const Camera& camera, const WalkInput& input) {
    const double yaw = input.turn_right * walk_turn, pitch = input.turn_up * walk_turn;
    if (input.forward == 0 && input.right == 0) return turned(camera, yaw, pitch);
    // Half the turn, the step, the other half: a curve walked with both kinds of key held then hardly depends on how
    // the time was cut into frames.
    Camera other = turned(camera, yaw / 2, pitch / 2);
    other.eye += (other.direction * input.forward + other.right * input.right) * walk_step;
    return turned(other, yaw / 2, pitch / 2);
}

}  // namespace raywalk
