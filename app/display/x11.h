// What GLFW does not tell of X11. Does nothing on other window systems, and where libX11 is not there.
#pragma once

#include <memory>

struct GLFWwindow;

namespace raywalk {

// From now on a display that goes away (its server ends) ends the program with our message and exit code 4, rather than
// with Xlib's and 1. For after glfwInit.
void end_when_the_display_is_lost();

// Whether other windows cover all of a window, as the X server sees it: desktops that compose windows never say so.
class Coverage {
  public:
    explicit Coverage(GLFWwindow* window);
    ~Coverage();
    Coverage(const Coverage&) = delete;
    Coverage& operator=(const Coverage&) = delete;
    [[nodiscard]] bool covered();

  private:
    struct State;
    std::unique_ptr<State> state_;  // none: never covered
};

}  // namespace raywalk
