// A window and its keys. Only the main thread may use it.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "app/display/x11.h"
#include "app/walk/input.h"

struct GLFWwindow;

namespace raywalk {

// What is printed on a key, UTF-8, empty if unknown; `latin`: whether its layout has Latin letters.
struct Label {
    std::string_view text;
    bool latin = true;
};

// The letter that a key means, in lower case; 0: none. What is printed on it, or where the layout has no Latin letters
// (Cyrillic, Greek, Hebrew, Arabic) what a US keyboard has in its place, which `glfw_key` names.
char letter_of(int glfw_key, const Label& label);

// What a key of the keyboard does. Walking goes by the key's place, so that W, S, A, D lie as they do on a US keyboard
// whatever is printed on them; T and Q go by letter_of, so that the key labelled A of a French keyboard, in the place
// of Q, does not quit. [ and ] go by place where no T or Q is printed on it. Escape and Ctrl+Q quit everywhere.
std::optional<WalkKey> walk_key(int glfw_key, const Label& label);

class Window {
  public:
    // Hidden at first; `size` in pixels, made smaller where the screen is. Throws NoDisplayError.
    Window(glm::ivec2 size, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] GLFWwindow* handle() const { return window_; }
    [[nodiscard]] glm::ivec2 pixels() const;  // of what is drawn; zero while minimised on some systems
    void show();
    void set_title(const std::string& title);

    // Handles events; returns after some came, after wake(), or after `seconds`.
    void wait(double seconds);
    // Ends a wait, from any thread.
    static void wake();
    static double now();  // seconds; the clock of `input`

    // What the events said. The reader clears what it has acted upon.
    Input input;
    bool resized = false;
    bool damaged = false;  // to be drawn again
    [[nodiscard]] bool close_requested() const;
    // Minimised, or wholly covered: nobody sees a new frame.
    [[nodiscard]] bool unseen();

  private:
    void connect();
    GLFWwindow* window_ = nullptr;
    std::optional<Coverage> coverage_;
};

}  // namespace raywalk
