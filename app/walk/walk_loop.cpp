#include "app/walk/walk_loop.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>

#include "app/process/interrupts.h"
#include "tracer/picture/camera.h"

namespace raywalk {
namespace {

constexpr double present_interval = 1.0 / 60;  // seconds; the driver's FIFO does not always hold frames back
constexpr double moving_interval = 1.0 / 120;  // between steps of the camera by held keys
constexpr double longest_step = 0.1;           // of held keys: after a stall the camera does not leap
constexpr double standing_after = 0.15;        // a key that is held in vain, at the end of a turn, moves nothing
constexpr double idle_interval = 0.2;          // between looks for a signal to end
constexpr double title_interval = 0.25;

double aspect(glm::ivec2 size) { return static_cast<double>(size.x) / size.y; }

std::string title_of(const std::string& name, const FrameInfo& frame, std::uint32_t limit) {
    char text[80];
    if (frame.samples == 0)
        std::snprintf(text, sizeof text, "preview %d x %d", frame.width, frame.height);
    else if (frame.finished)
        std::snprintf(text, sizeof text, "%u sample%s", frame.samples, frame.samples == 1 ? "" : "s");
    else
        std::snprintf(text, sizeof text, "%u of %u samples", frame.samples, limit);
    std::string title = "Raywalk - " + name + " - " + text;
    if (frame.trace_seconds > 0) {
        std::snprintf(text, sizeof text, " - %.0f ms (%.0f/s)", frame.trace_seconds * 1000, 1 / frame.trace_seconds);
        title += text;
    }
    return title;
}

// One run of the loop, its state between two events.
struct Walk {
    Window& window;
    Presenter& presenter;
    RenderThread& render;
    const WalkSetup& setup;
    WalkRecord record = {};

    View view = setup.view;
    int exposure_presses = 0;  // of the window's keys, that the render thread knows of
    bool visible = false, present_again = false, title_stale = false;
    double next_present = 0, next_title = 0, last_change = -standing_after;
    double last_shown = 0;
    bool moving = false;        // keys move the camera
    bool shown_moving = false;  // they did when the last frame was shown
    std::uint64_t newest_id = 1;
    struct Change {
        std::uint64_t id;
        double seconds;
    };
    std::optional<Change> unanswered = {};  // the oldest change that no frame shows yet

    void follow_input(double now);
    void follow_size();
    void show_frame(double now);
    [[nodiscard]] bool frame_due() const { return presenter.exchange().fresh() || present_again || window.damaged; }
    [[nodiscard]] double patience(double now) const;
};

void Walk::follow_size() {
    const glm::ivec2 size = window.pixels();
    if (size.x <= 0 || size.y <= 0) return;  // minimised: the picture waits as it is
    if (size == glm::ivec2{view.width, view.height}) return;
    view.camera = reshaped(view.camera, aspect({view.width, view.height}), aspect(size));
    view.width = size.x;
    view.height = size.y;
    presenter.resized();
    present_again = true;
}

void Walk::follow_input(double now) {
    if (window.resized) {
        window.resized = false;
        follow_size();
    }
    window.input.skip(now - longest_step);
    view.camera = window.input.advance(view.camera, now);
    if (const int presses = window.input.exposure_presses(); presses != exposure_presses) {
        exposure_presses = presses;
        render.expose(exposure_factor(setup.exposure_presses + presses));
    }
    moving = window.input.moving() && now - last_change < standing_after;
    const std::uint64_t id = render.show(view, moving);
    if (id == newest_id) return;
    newest_id = id;
    last_change = now;
    if (!unanswered) unanswered = {id, now};
}

void Walk::show_frame(double now) {
    if (!visible) {
        window.show();
        visible = true;
    }
    window.damaged = false;
    const Presenter::Outcome outcome = presenter.present();
    const double shown = Window::now();
    present_again = outcome == Presenter::Outcome::again;
    next_present = std::max(next_present + present_interval, now);  // a frame that came late does not delay the next
    if (outcome == Presenter::Outcome::hidden) return;
    if (record.present_seconds.empty()) presenter.warm_up();
    record.present_seconds.push_back(shown - now);
    if (moving && shown_moving && unanswered)
        record.frame_intervals.push_back(shown - std::max(last_shown, unanswered->seconds));
    shown_moving = moving;
    last_shown = shown;
    title_stale = true;
    if (unanswered && presenter.shown_frame().camera_id >= unanswered->id) {
        record.answer_seconds.push_back(shown - unanswered->seconds);
        unanswered.reset();
    }
}

double Walk::patience(double now) const {
    double seconds = idle_interval;
    if (window.input.moving()) seconds = std::min(seconds, moving_interval);
    if (frame_due()) seconds = std::min(seconds, next_present - now);
    if (title_stale) seconds = std::min(seconds, next_title - now);
    return seconds;
}

}  // namespace

WalkRecord walk_loop(Window& window, Presenter& presenter, RenderThread& render, const WalkSetup& setup) {
    Walk walk{.window = window, .presenter = presenter, .render = render, .setup = setup};
    for (;;) {
        const double now = Window::now();
        if (const auto failure = render.failure()) std::rethrow_exception(failure);
        render.rest(window.unseen());
        walk.follow_input(now);
        walk.record.interrupted = interrupted();
        if (window.input.quit() || window.close_requested() || walk.record.interrupted) break;
        if (walk.frame_due() && now >= walk.next_present) walk.show_frame(now);
        if (walk.title_stale && now >= walk.next_title) {
            window.set_title(title_of(setup.name, presenter.shown_frame(), setup.sample_limit));
            walk.title_stale = false;
            walk.next_title = now + title_interval;
        }
        if (setup.quit_at_once && presenter.shown_frame().samples > 0) break;
        window.wait(walk.patience(Window::now()));
    }
    walk.record.camera = walk.view.camera;
    return std::move(walk.record);
}

}  // namespace raywalk
