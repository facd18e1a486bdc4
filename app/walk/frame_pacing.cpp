#include "app/walk/frame_pacing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace raywalk {
namespace {

// Divisors of width and height, about sqrt(2) apart: a step halves or doubles the work.
constexpr std::array divisors = {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 11.0, 16.0, 22.0};
constexpr int smallest_side = 8;  // pixels
constexpr double spare = 0.8;     // of the frame's time: a larger size must fit in this part of it
constexpr int spare_frames = 4;   // so many frames in a row must have had the time

glm::ivec2 divided(glm::ivec2 window, int step) {
    const auto side = [&](int pixels) {
        return std::min(pixels, std::max(smallest_side, static_cast<int>(std::lround(pixels / divisors[step]))));
    };
    return {side(window.x), side(window.y)};
}

double pixels_of(glm::ivec2 size) { return static_cast<double>(size.x) * size.y; }

}  // namespace

glm::ivec2 FramePacing::size(glm::ivec2 window) const { return divided(window, step_); }

void FramePacing::measured(double pixels, double seconds, glm::ivec2 window) {
    if (pixels <= 0 || seconds <= 0) return;
    const double now = seconds / pixels;
    const bool first = !knows();
    // One slow frame may be the system's doing; two are the scene's.
    seconds_per_pixel_ = first ? now : std::min(now, last_seconds_per_pixel_);
    last_seconds_per_pixel_ = now;

    const auto time_of = [&](int step) { return seconds_per_pixel_ * pixels_of(divided(window, step)); };
    if (first || time_of(step_) > frame_seconds_) {
        // At once to the largest size that is fast enough.
        if (first) step_ = 0;
        while (step_ + 1 < static_cast<int>(divisors.size()) && time_of(step_) > frame_seconds_) ++step_;
        spare_frames_ = 0;
    } else if (step_ > 0 && time_of(step_ - 1) < spare * frame_seconds_) {
        if (++spare_frames_ < spare_frames) return;
        --step_;
        spare_frames_ = 0;
    } else {
        spare_frames_ = 0;
    }
}

}  // namespace raywalk
