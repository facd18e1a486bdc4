#include "app/walk/input.h"

#include <algorithm>
#include <optional>

namespace raywalk {
namespace {

// Opposite keys are neighbours: index ^ 1.
constexpr std::array moving_keys = {WalkKey::forward, WalkKey::back,      WalkKey::right,      WalkKey::left,
                                    WalkKey::turn_up, WalkKey::turn_down, WalkKey::turn_right, WalkKey::turn_left};

std::optional<std::size_t> index_of(WalkKey key) {
    const auto found = std::ranges::find(moving_keys, key);
    if (found == moving_keys.end()) return {};
    return static_cast<std::size_t>(found - moving_keys.begin());
}

}  // namespace

void Input::release_all(double seconds) {
    for (const WalkKey key : moving_keys) release(key, seconds);
}

Camera Input::advance(const Camera& camera, double seconds) {
    Camera now = camera;
    for (const Event& event : events_) {
        now = moved_until(now, event.seconds);
        now_ = std::max(now_, event.seconds);
        apply(event, now);
    }
    events_.clear();
    now = moved_until(now, seconds);
    now_ = std::max(now_, seconds);
    return now;
}

bool Input::moving() const {
    for (std::size_t i = 0; i < held_.size(); i += 2)
        if (held_[i].down != held_[i + 1].down) return true;
    return false;
}

// Presses' worth of motion from now_ to `seconds` along one axis.
double Input::balance(std::size_t plus, std::size_t minus, double seconds) const {
    if (held_[plus].down == held_[minus].down) return 0;
    const Held& held = held_[plus].down ? held_[plus] : held_[minus];
    const double presses = std::max(0.0, seconds - std::max(now_, held.moves_from)) * walk_presses_per_second;
    return held_[plus].down ? presses : -presses;
}

Camera Input::moved_until(const Camera& camera, double seconds) const {
    return walk(camera, {.forward = balance(0, 1, seconds),
                         .right = balance(2, 3, seconds),
                         .turn_right = balance(6, 7, seconds),
                         .turn_up = balance(4, 5, seconds)});
}

void Input::apply(const Event& event, Camera& camera) {
    if (quit_) return;
    const auto index = index_of(event.key);
    if (!index) {
        if (!event.down) return;
        camera = pressed(camera, event.key);
        exposure_presses_ += raywalk::exposure_presses(event.key);
        if (event.key != WalkKey::quit) return;
        quit_ = true;
        held_ = {};  // nothing moves any more
        return;
    }
    Held& held = held_[*index];
    if (held.down == event.down) return;
    held = {.down = event.down, .moves_from = event.seconds};
    if (event.down && !held_[*index ^ 1].down) {
        camera = pressed(camera, event.key);
        held.moves_from += 1 / walk_presses_per_second;
    }
}

}  // namespace raywalk
