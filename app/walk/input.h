// Keys of the walk, by time: what is pressed and held between two moments moves the camera (spec 2). Presses of the
// exposure are counted.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "app/walk/walk.h"
#include "tracer/picture/camera.h"

namespace raywalk {

// Seconds are of one clock that never goes back. A press moves the camera by exactly one step, at once; a key that is
// still down when that step's time (1 / walk_presses_per_second) is over goes on by time. So a short press is one step
// whatever the frame rate, and a long one is ten steps' worth a second. Opposite keys cancel while both are down.
class Input {
  public:
    void press(WalkKey key, double seconds) { events_.push_back({key, true, seconds}); }
    void release(WalkKey key, double seconds) { events_.push_back({key, false, seconds}); }
    // Every key counts as released: the window lost the focus and will not see the real releases.
    void release_all(double seconds);

    // The camera at `seconds`, from the one at the last call. Events since then act in the order of their arrival.
    Camera advance(const Camera& camera, double seconds);

    // Held keys move nothing in the time before `seconds` that no advance has seen: the walk stood still then.
    void skip(double seconds) { now_ = std::max(now_, seconds); }

    // Whether the camera moves or will move by keys that are down.
    [[nodiscard]] bool moving() const;
    [[nodiscard]] bool quit() const { return quit_; }
    // Of all that advance has seen, to be given to exposure_factor.
    [[nodiscard]] int exposure_presses() const { return exposure_presses_; }

  private:
    struct Event {
        WalkKey key;
        bool down;
        double seconds;
    };
    struct Held {
        bool down = false;
        double moves_from = 0;  // when its continuous motion begins
    };
    [[nodiscard]] Camera moved_until(const Camera& camera, double seconds) const;
    [[nodiscard]] double balance(std::size_t plus, std::size_t minus, double seconds) const;
    void apply(const Event& event, Camera& camera);

    std::vector<Event> events_;
    std::array<Held, 8> held_;  // by index_of
    double now_ = 0;
    int exposure_presses_ = 0;
    bool quit_ = false;
};

}  // namespace raywalk
