#include "app/display/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <vector>

#include "app/display/icon.h"
#include "app/display/no_display.h"
#include "app/display/x11.h"

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

void set_icon(GLFWwindow* window) {
    std::array<std::vector<std::uint8_t>, 3> pixels;
    std::array<GLFWimage, 3> images{};
    constexpr std::array sides = {16, 32, 64};
    for (std::size_t i = 0; i < sides.size(); ++i) {
        pixels[i] = icon_pixels(sides[i]);
        images[i] = {sides[i], sides[i], pixels[i].data()};
    }
    glfwSetWindowIcon(window, static_cast<int>(images.size()), images.data());
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

// Whether the keys in the places of letters are labelled with Latin ones.
bool layout_is_latin() {
    for (int key = GLFW_KEY_A; key <= GLFW_KEY_Z; ++key) {
        const char* text = glfwGetKeyName(key, 0);
        if (text != nullptr && letter_of(key, {text, true}) != '\0') return true;
    }
    return false;
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    if (action == GLFW_REPEAT) return;
    Window& self = of(window);
    const double now = Window::now();
    const bool down = action == GLFW_PRESS;
    const char* text = glfwGetKeyName(key, scancode);
    const Label label = {text != nullptr ? text : "", layout_is_latin()};
    auto known = walk_key(key, label);
    // Chords belong to the desktop, but for Ctrl+Q; releases count always, as the modifier may have come after the
    // press.
    if (down && (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER))) {
        if ((modifiers & GLFW_MOD_CONTROL) == 0 || letter_of(key, label) != 'q') return;
        known = WalkKey::quit;
    }
    if (!known) return;
    if (down)
        self.input.press(*known, now);
    else
        self.input.release(*known, now);
}

}  // namespace

char letter_of(int glfw_key, const Label& label) {
    // GLFW names places by the capital letters of a US keyboard.
    const bool letter_place = glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z;
    if (!label.latin || label.text.empty()) return letter_place ? static_cast<char>(glfw_key | 0x20) : '\0';
    if (label.text.size() != 1) return '\0';
    const auto letter = static_cast<char>(label.text[0] | 0x20);
    return letter >= 'a' && letter <= 'z' ? letter : '\0';
}

std::optional<WalkKey> walk_key(int glfw_key, const Label& label) {
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
    switch (letter_of(glfw_key, label)) {
        case 't':
            return WalkKey::toggle;
        case 'q':
            return WalkKey::quit;
        default:
            break;
    }
    if (glfw_key == GLFW_KEY_LEFT_BRACKET) return WalkKey::darker;
    if (glfw_key == GLFW_KEY_RIGHT_BRACKET) return WalkKey::brighter;
    return {};
}

Window::Window(glm::ivec2 size, const std::string& title) {
    if (!glfwInit()) no_display("no display for the window");
    end_when_the_display_is_lost();
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "Raywalk");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "raywalk");
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
    set_icon(window_);
    connect();
    coverage_.emplace(window_);
}

Window::~Window() {
    coverage_.reset();
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
bool Window::unseen() { return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0 || coverage_->covered(); }
bool Window::close_requested() const { return glfwWindowShouldClose(window_); }

}  // namespace raywalk
