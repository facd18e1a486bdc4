#include "app/walk/walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace raywalk {

namespace {

constexpr float exposure_per_press = 1.25f;
constexpr int most_exposure_presses = 300;  // a factor of 1e29: black or white long before

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

Camera walk(const Camera& camera, const WalkInput& input) {
    const double yaw = input.turn_right * walk_turn, pitch = input.turn_up * walk_turn;
    if (input.forward == 0 && input.right == 0) return turned(camera, yaw, pitch);
    // Half the turn, the step, the other half: a curve walked with both kinds of key held then hardly depends on how
    // the time was cut into frames.
    Camera other = turned(camera, yaw / 2, pitch / 2);
    other.eye += (other.direction * input.forward + other.right * input.right) * walk_step;
    return turned(other, yaw / 2, pitch / 2);
}

Camera pressed(const Camera& camera, WalkKey key) {
    switch (key) {
        case WalkKey::forward:
            return walk(camera, {.forward = 1});
        case WalkKey::back:
            return walk(camera, {.forward = -1});
        case WalkKey::left:
            return walk(camera, {.right = -1});
        case WalkKey::right:
            return walk(camera, {.right = 1});
        case WalkKey::turn_up:
            return walk(camera, {.turn_up = 1});
        case WalkKey::turn_down:
            return walk(camera, {.turn_up = -1});
        case WalkKey::turn_left:
            return walk(camera, {.turn_right = -1});
        case WalkKey::turn_right:
            return walk(camera, {.turn_right = 1});
        case WalkKey::toggle:
            return toggled_projection(camera);
        case WalkKey::darker:
        case WalkKey::brighter:
        case WalkKey::quit:
            break;
    }
    return camera;
}

Camera pressed(const Camera& camera, std::span<const WalkKey> keys) {
    Camera walked = camera;
    for (const WalkKey key : keys) {
        if (key == WalkKey::quit) break;
        walked = pressed(walked, key);
    }
    return walked;
}

int exposure_presses(WalkKey key) {
    if (key == WalkKey::brighter) return 1;
    return key == WalkKey::darker ? -1 : 0;
}

int exposure_presses(std::span<const WalkKey> keys) {
    int presses = 0;
    for (const WalkKey key : keys) {
        if (key == WalkKey::quit) break;
        presses += exposure_presses(key);
    }
    return presses;
}

float exposure_factor(int presses) {
    return std::pow(exposure_per_press,
                    static_cast<float>(std::clamp(presses, -most_exposure_presses, most_exposure_presses)));
}

}  // namespace raywalk
