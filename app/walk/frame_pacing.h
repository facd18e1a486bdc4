// How many pixels a frame of the moving camera may have, by the time that the last ones took.
#pragma once

#include <glm/vec2.hpp>

namespace raywalk {

// A frame has 1 / divisor of the window's pixels a side. The divisor grows when two frames were late, and shrinks
// only after several frames had time to spare, so that the picture does not hop between two sizes.
class FramePacing {
  public:
    // `frame_seconds`: what a frame of the moving camera should take at most. Less than a sixtieth of a second, since a
    // driver in software takes its part of the same cores' time to show it.
    explicit FramePacing(double frame_seconds = 1.0 / 75) : frame_seconds_(frame_seconds) {}

    // The size to trace for a window of this size: the full one where that takes no longer than a frame should.
    [[nodiscard]] glm::ivec2 size(glm::ivec2 window) const;
    // `pixels` of a frame took `seconds` (a frame that was given up counts what it has).
    void measured(double pixels, double seconds, glm::ivec2 window);

    // What a frame of so many pixels should take; 0 while nothing was measured.
    [[nodiscard]] double seconds_for(glm::ivec2 size) const { return seconds_per_pixel_ * size.x * size.y; }

    // Until something was measured a frame is small for certain.
    [[nodiscard]] bool knows() const { return seconds_per_pixel_ > 0; }
    [[nodiscard]] int step() const { return step_; }

  private:
    double frame_seconds_;
    double seconds_per_pixel_ = 0;       // the less of the last two frames
    double last_seconds_per_pixel_ = 0;  // of the last frame
    int step_ = first_step;
    int spare_frames_ = 0;

    static constexpr int first_step = 7;
};

}  // namespace raywalk
