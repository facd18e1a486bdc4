#include "app/display/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "app/display/presenter.h"

namespace raywalk {
namespace {

constexpr const char* no_window_advice =
    "\n  `--capture OUT` shows what the window would, without one; `-render OUT` makes a picture.";

[[noreturn]] void no_display(const std::string& what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw NoDisplayError(what + (reason ? std::string(" (") + reason + ")" : "") + no_window_advice);
}

// The size, or the largest of the same shape that the screen has room for.
glm::ivec2 fitting_screen(glm::ivec2 size) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (!monitor) return size;
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    if (width <= 0 || height <= 0) return size;
    const double shrink = std::min({1.0, static_cast<double>(width) / size.x, static_cast<double>(height) / size.y});
    return {std::max(1, static_cast<int>(size.x * shrink)), std::max(1, static_cast<int>(size.y * shrink))};
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    if (action == GLFW_REPEAT) return;
    Window& self = of(window);
    const double now = Window::now();
    const bool down = action == GLFW_PRESS;
    // Chords belong to the desktop; releases count always, as the modifier may have come after the press.
    if (down && (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER))) return;
    if (down && key == GLFW_KEY_RIGHT_BRACKET) ++self.exposure_presses;
    if (down && key == GLFW_KEY_LEFT_BRACKET) --self.exposure_presses;
    const char* label = glfwGetKeyName(key, scancode);
    const auto known = walk_key(key, label ? label : "");
    if (!known) return;
    if (down)
        self.input.press(*known, now);
    else
        self.input.release(*known, now);
}

}  // namespace

std::optional<WalkKey> walk_key(int glfw_key, std::string_view label) {
    switch (glfw_key) {
        case GLFW_KEY_W:
            return WalkKey::forward;
        case GLFW_KEY_S:
            return WalkKey::back;
        case GLFW_KEY_A:
            return WalkKey::left;
        case GLFW_KEY_D:
            return WalkKey::right;
        case GLFW_KEY_UP:
            return WalkKey::turn_up;
        case GLFW_KEY_DOWN:
            return WalkKey::turn_down;
        case GLFW_KEY_LEFT:
            return WalkKey::turn_left;
        case GLFW_KEY_RIGHT:
            return WalkKey::turn_right;
        case GLFW_KEY_ESCAPE:
            return WalkKey::quit;
        default:
            break;
    }
    if (label == "t" || label == "T" || (label.empty() && glfw_key == GLFW_KEY_T)) return WalkKey::toggle;
    if (label == "q" || label == "Q" || (label.empty() && glfw_key == GLFW_KEY_Q)) return WalkKey::quit;
    return {};
}

Window::Window(glm::ivec2 size, const std::string& title) {
    if (!glfwInit()) no_display("no display for the window");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    const glm::ivec2 fitting = fitting_screen(size);
    window_ = glfwCreateWindow(fitting.x, fitting.y, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const char* reason = nullptr;
        glfwGetError(&reason);
        const std::string what =
            std::string("no window could be opened") + (reason ? std::string(" (") + reason + ")" : "");
        glfwTerminate();
        throw NoDisplayError(what + no_window_advice);
    }
    connect();
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::connect() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, on_key);
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) { of(window).resized = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { of(window).damaged = true; });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int focused) {
        if (!focused) of(window).input.release_all(now());
    });
    glfwSetWindowIconifyCallback(window_, [](GLFWwindow* window, int iconified) {
        if (!iconified) of(window).damaged = true;
    });
}

glm::ivec2 Window::pixels() const {
    glm::ivec2 size{0};
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
}

void Window::show() { glfwShowWindow(window_); }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }
void Window::wait(double seconds) {
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}
void Window::wake() { glfwPostEmptyEvent(); }
double Window::now() { return glfwGetTime(); }
bool Window::close_requested() const { return glfwWindowShouldClose(window_); }

}  // namespace raywalk
