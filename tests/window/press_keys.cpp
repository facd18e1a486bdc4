// Presses keys as a keyboard would: press_keys NAME... Waits for the server after each, and a little: keys of one
// millisecond can be lost to GLFW, and xdotool does not wait.
#include <X11/Xlib.h>
#include <X11/extensions/XTest.h>
#include <unistd.h>

int main(int count, char** names) {
    Display* display = XOpenDisplay(nullptr);
    if (!display) return 1;
    for (int i = 1; i < count; ++i) {
        const KeyCode code = XKeysymToKeycode(display, XStringToKeysym(names[i]));
        if (code == 0) return 1;
        XTestFakeKeyEvent(display, code, True, CurrentTime);  // both at once: it is not held
        XTestFakeKeyEvent(display, code, False, CurrentTime);
        XSync(display, False);
        usleep(2000);
    }
    XCloseDisplay(display);
}
