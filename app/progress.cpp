#include "app/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/console.h"

namespace raywalk {

namespace {

using namespace std::chrono_literals;

constexpr auto redraw_interval = 100ms;

int terminal_columns() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

std::string remaining_text(double fraction, double elapsed_seconds) {
    if (fraction <= 0 || fraction >= 1) return {};
    const double remaining = elapsed_seconds / fraction * (1 - fraction);
    if (remaining > 9.5) return duration_text(std::round(remaining)) + " left";
    char text[32];
    std::snprintf(text, sizeof text, "%.1f s left", remaining);  // more digits would only flicker
    return text;
}

}  // namespace

std::string progress_line(double fraction, double elapsed_seconds, int columns) {
    // Rounded down: 100 % is only ever the end.
    char percent[16];
    std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(std::floor(fraction * 100)));
    std::string text = percent;
    if (const std::string remaining = remaining_text(fraction, elapsed_seconds); !remaining.empty())
        text += ", " + remaining;

    constexpr int reserved_for_text = 24, smallest_bar = 8, largest_bar = 60;
    const int bar = std::min(columns - reserved_for_text - 3, largest_bar);
    if (bar >= smallest_bar) {
        const auto filled = static_cast<std::size_t>(std::floor(fraction * bar));
        text = "[" + std::string(filled, '#') + std::string(static_cast<std::size_t>(bar) - filled, '-') + "] " + text;
    }
    if (text.size() > static_cast<std::size_t>(std::max(columns, 0))) text.resize(static_cast<std::size_t>(columns));
    return text;
}

WorkingTime::Step WorkingTime::step(double seconds) {
    constexpr double longest_step = 1;  // ten times the usual one: a machine under load is late, too
    if (seconds > longest_step) return Step::paused;
    seconds_ += seconds;
    return Step::worked;
}

Progress::Style Progress::style_for(bool quiet) {
    if (quiet) return Style::silent;
    return standard_error().rewritable ? Style::bar : Style::lines;
}

Progress::Progress(Style style, std::uint64_t total)
    : style_(style), total_(total), last_look_(std::chrono::steady_clock::now()) {
    if (style != Style::silent) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Progress::finish() {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
    if (style_ == Style::lines) show();
    if (style_ == Style::bar && !line_shown_.empty()) show_if_ready("\r\x1b[K");
}

void Progress::run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        wake_.wait_for(lock, stop, redraw_interval, [] { return false; });
        if (!stop.stop_requested()) show();
    }
}

void Progress::show() {
    if (style_ == Style::bar) {
        // One column stays free: writing into the last one wraps on some terminals.
        const double seconds = elapsed();
        const std::string line = progress_line(fraction(), seconds, terminal_columns() - 1);
        if (line == line_shown_) return;
        show_if_ready("\r" + line + "\x1b[K");
        line_shown_ = line;
        return;
    }
    const double seconds = elapsed();
    const int tenths = static_cast<int>(std::floor(fraction() * 10));
    while (tenths_shown_ < tenths) {
        ++tenths_shown_;
        const double shown = tenths_shown_ / 10.0;
        std::string line = std::to_string(tenths_shown_ * 10) + " %";
        if (tenths_shown_ == tenths && tenths < 10) line += ", " + remaining_text(shown, seconds);
        show_if_ready(line + "\n");
    }
}

double Progress::fraction() const {
    return total_ == 0 ? 1
                       : std::min(1.0, static_cast<double>(done_.load(std::memory_order_relaxed)) /
                                           static_cast<double>(total_));
}

double Progress::elapsed() {
    const auto now = std::chrono::steady_clock::now();
    const WorkingTime::Step step = working_.step(std::chrono::duration<double>(now - last_look_).count());
    last_look_ = now;
    if (step == WorkingTime::Step::paused) line_shown_.clear();  // the shell has written over it
    return working_.seconds();
}

}  // namespace raywalk
