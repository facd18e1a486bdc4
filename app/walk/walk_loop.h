// The walk in a window: keys to camera, camera to frames, frames to the screen.
#pragma once

#include <vector>

#include "app/display/presenter.h"
#include "app/display/window.h"
#include "app/walk/render_thread.h"
#include "tracer/rendering/renderer.h"

namespace raywalk {

struct WalkSetup {
    std::string name;                // of the scene, for the title
    View view;                       // the first one, keys of the command line already pressed
    int exposure_presses = 0;        // of those keys; the render thread was made with them
    std::uint32_t sample_limit = 1;  // a pixel
    bool quit_at_once = false;       // after the first whole picture
};

struct WalkRecord {
    std::vector<double> answer_seconds;   // from a change of the view to the frame on the screen that shows it
    std::vector<double> present_seconds;  // what the window's thread took for each frame
    std::vector<double> frame_intervals;  // seconds for which a moving camera's screen stood: since the frame before,
                                          // or the change of the view where that came later
    Camera camera;                        // the last one
    bool interrupted = false;
};

// Runs until the user quits. Throws WorkError.
WalkRecord walk_loop(Window& window, Presenter& presenter, RenderThread& render, const WalkSetup& setup);

}  // namespace raywalk
