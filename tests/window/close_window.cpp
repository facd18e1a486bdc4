// Presses a window's close button: sends what a window manager would. close_window WINDOW_ID
#include <X11/Xlib.h>

#include <cstdlib>

int main(int count, char** arguments) {
    Display* display = count == 2 ? XOpenDisplay(nullptr) : nullptr;
    if (!display) return 1;
    XEvent event = {};
    event.xclient.type = ClientMessage;
    event.xclient.window = std::strtoul(arguments[1], nullptr, 0);
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    const bool sent = XSendEvent(display, event.xclient.window, False, NoEventMask, &event) != 0;
    XCloseDisplay(display);
    return sent ? 0 : 1;
}
