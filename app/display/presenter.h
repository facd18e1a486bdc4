// Frames on the screen, or in memory when there is no screen, by Vulkan. The Vulkan library is opened here, when a
// presenter is made, so that nothing else of the program needs it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/display/frame_exchange.h"

struct GLFWwindow;

namespace raywalk {

// How a frame came to its target, for statistics and tests.
enum class FramePath { copy, scale, resolve, resolve_and_scale };

// Shows frames in a window. Belongs to one thread, but for exchange(), whose writing side is the render thread's.
// Throws WorkError when the device is lost, NoDisplayError where nothing can be shown or the display is lost.
class Presenter {
  public:
    explicit Presenter(GLFWwindow* window);
    ~Presenter();

    [[nodiscard]] FrameExchange& exchange();
    // What frames should hold: display values, or radiance where the device resolves it (a discrete one).
    [[nodiscard]] FrameContent preferred_content() const;
    [[nodiscard]] const std::string& device_name() const;

    enum class Outcome {
        shown,
        again,   // the window changed meanwhile: call once more
        hidden,  // no frame yet, or the window has no area (minimised)
    };
    // Shows the newest frame; the last one again where there is no newer.
    Outcome present();
    // The window's framebuffer has another size now.
    void resized();
    // Compiles the shaders that only some frames need, so that the first of those does not wait for it.
    void warm_up();
    [[nodiscard]] const FrameInfo& shown_frame() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// The same frames drawn by the same commands into an image that is read back: no window, no display, no GLFW.
class OffscreenPresenter {
  public:
    OffscreenPresenter();
    ~OffscreenPresenter();

    [[nodiscard]] FrameExchange& exchange();
    [[nodiscard]] FrameContent preferred_content() const;
    [[nodiscard]] const std::string& device_name() const;

    // The newest frame as a window of this size shows it: width * height words 0xffRRGGBB, rows from the top.
    std::vector<std::uint32_t> present(int width, int height);
    [[nodiscard]] FramePath last_path() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raywalk
