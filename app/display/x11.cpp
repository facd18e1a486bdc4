#include "app/display/x11.h"

#include <X11/Xlib.h>
#include <dlfcn.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/process/console.h"

namespace raywalk {
namespace {

// The library that GLFW opened, if it did; closed with the handle.
class Xlib {
  public:
    Xlib() : handle_(dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD)) {}
    ~Xlib() {
        if (handle_ != nullptr) dlclose(handle_);
    }
    Xlib(const Xlib&) = delete;
    Xlib& operator=(const Xlib&) = delete;
    template <class Function>
    Function* function(const char* name) const {
        return handle_ == nullptr ? nullptr : reinterpret_cast<Function*>(dlsym(handle_, name));
    }

  private:
    void* handle_;
};

// Xlib ends the program when this returns.
int on_display_lost(Display*) {
    print_error("the display was lost: its server ended, or the connection did\n  start again on another display");
    _exit(exit_no_display);
}

}  // namespace

void end_when_the_display_is_lost() {
    if (const auto set_handler = Xlib().function<decltype(XSetIOErrorHandler)>("XSetIOErrorHandler"))
        set_handler(on_display_lost);
}

// A connection of its own, as GLFW keeps the events of its own to itself.
struct Coverage::State {
    Xlib library;
    Display* display = nullptr;
    decltype(XPending)* pending = nullptr;
    decltype(XNextEvent)* next_event = nullptr;
    bool covered = false;

    ~State() {
        if (display == nullptr) return;
        if (const auto close_display = library.function<decltype(XCloseDisplay)>("XCloseDisplay"))
            close_display(display);
    }
    // False where there is no X11.
    bool watch(GLFWwindow* window) {
        using XWindowOf = ::Window(GLFWwindow*);  // only in GLFW's library for X11
        const auto window_of = reinterpret_cast<XWindowOf*>(dlsym(RTLD_DEFAULT, "glfwGetX11Window"));
        const auto open_display = library.function<decltype(XOpenDisplay)>("XOpenDisplay");
        const auto select_input = library.function<decltype(XSelectInput)>("XSelectInput");
        pending = library.function<decltype(XPending)>("XPending");
        next_event = library.function<decltype(XNextEvent)>("XNextEvent");
        if (!window_of || !open_display || !select_input || !pending || !next_event) return false;
        const ::Window id = window_of(window);
        if (id == None) return false;
        display = open_display(nullptr);
        if (display == nullptr) return false;
        select_input(display, id, VisibilityChangeMask);
        return true;
    }
};

Coverage::Coverage(GLFWwindow* window) : state_(std::make_unique<State>()) {
    if (!state_->watch(window)) state_.reset();
}
Coverage::~Coverage() = default;

bool Coverage::covered() {
    if (!state_) return false;
    while (state_->pending(state_->display) > 0) {
        XEvent event;
        state_->next_event(state_->display, &event);
        if (event.type == VisibilityNotify) state_->covered = event.xvisibility.state == VisibilityFullyObscured;
    }
    return state_->covered;
}

}  // namespace raywalk
