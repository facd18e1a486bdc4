#include "app/process/console.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "tracer/ground/file_bytes.h"

namespace raywalk {

namespace {

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
}

// 0, or the error that kept `text` from being written.
int write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = write(descriptor, text.data(), text.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        text.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
}

// All that stderr takes within `patience`: nothing said there is worth more than the work.
void write_error_within(std::chrono::milliseconds patience, std::string_view text) {
    // A pipe that poll calls writable takes this much without waiting.
    constexpr std::size_t piece = 512;
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + patience;
    while (!text.empty()) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd place{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
        const int ready = poll(&place, 1, static_cast<int>(std::max<std::int64_t>(left, 0)));
        if (ready == 0) return;
        if (ready < 0 && errno != EINTR) return;
        if (ready < 0) continue;
        const ssize_t count = write(STDERR_FILENO, text.data(), std::min(text.size(), piece));
        if (count < 0 && errno != EINTR && errno != EAGAIN) return;
        if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    }
}

constexpr std::chrono::milliseconds message_patience{500};

// Of messages of the system and of libraries, too, nothing may steer the terminal; their lines stay.
std::string harmless(std::string_view text) {
    std::string lines;
    for (;;) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines += printable(text.substr(0, end));
        if (end == text.size()) return lines;
        lines += '\n';
        text.remove_prefix(end + 1);
    }
}

// `code`: an SGR colour of the terminal.
std::string coloured(std::string_view text, std::string_view code) {
    if (!standard_error().colours) return std::string(text);
    return "\x1b[" + std::string(code) + "m" + std::string(text) + "\x1b[0m";
}

void print_labelled(std::string_view label, std::string_view colour, std::string_view what) {
    write_error_within(message_patience, "raywalk: " + coloured(label, colour) + " " + harmless(what) + "\n");
}

constexpr std::string_view red = "1;31", magenta = "1;35";

// Shows the lines that diagnostics point to; a file that many point to is read once.
class Lines {
  public:
    // The diagnostic with its line, unless it has it already, must not show it, or the file changed meanwhile.
    Diagnostic added_to(Diagnostic diagnostic) {
        if (!diagnostic.source_line.empty() || diagnostic.where.line == 0 || !diagnostic.quotable) return diagnostic;
        if (diagnostic.where.file != file_) read(diagnostic.where.file);
        if (diagnostic.where.line > starts_.size()) return diagnostic;
        std::string_view line = bytes_->text().substr(starts_[diagnostic.where.line - 1]);
        line = line.substr(0, line.find('\n'));
        if (line.ends_with('\r')) line.remove_suffix(1);
        quote_line(diagnostic, line);
        return diagnostic;
    }

  private:
    void read(const std::string& file) {
        constexpr std::uint64_t largest_file = 256 << 20;
        file_ = file;
        starts_.clear();
        try {
            bytes_.emplace(read_file_bytes(open_file(file), largest_file));
        } catch (const FileProblem&) {
            return;
        }
        const std::string_view text = bytes_->text();
        for (std::size_t at = 0; at != std::string_view::npos;) {
            starts_.push_back(at);
            at = text.find('\n', at);
            if (at != std::string_view::npos) ++at;
        }
    }

    std::string file_;
    std::optional<FileBytes> bytes_;
    std::vector<std::size_t> starts_;  // of lines
};

}  // namespace

Console standard_error() {
    const char* terminal = std::getenv("TERM");
    const bool dumb = terminal == nullptr || *terminal == '\0' || std::string_view(terminal) == "dumb";
    const bool rewritable = isatty(STDERR_FILENO) != 0 && !dumb;
    return {.rewritable = rewritable, .colours = rewritable && !is_set("NO_COLOR")};
}

void print_error(std::string_view what) { print_labelled("error:", red, what); }
void print_warning(std::string_view what) { print_labelled("warning:", magenta, what); }
void print_note(std::string_view what) { write_error_within(message_patience, "raywalk: " + harmless(what) + "\n"); }

void show_if_ready(std::string_view text) { write_error_within(std::chrono::milliseconds{0}, text); }

void print_diagnostics(std::span<const Diagnostic> diagnostics) {
    std::string text;
    Lines lines;
    for (const Diagnostic& diagnostic : diagnostics) {
        std::string one = to_string(lines.added_to(diagnostic));
        const bool is_error = diagnostic.severity == Severity::error;
        const std::string_view label = is_error ? ": error: " : ": warning: ";
        if (const std::size_t at = one.find(label, printable(diagnostic.where.file).size()); at != std::string::npos)
            one.replace(at + 2, label.size() - 3,
                        coloured(label.substr(2, label.size() - 3), is_error ? red : magenta));
        text += one + "\n";
    }
    write_error_within(message_patience, text);
}

void print_result(std::string_view text) {
    if (const int error = write_all(STDOUT_FILENO, text); error != 0)
        fail_with("cannot write to standard output", error);
}

std::string duration_text(double seconds) {
    char text[64];
    if (seconds < 0.0995)
        std::snprintf(text, sizeof text, "%.1f ms", seconds * 1000);
    else if (seconds < 9.995)
        std::snprintf(text, sizeof text, "%.2f s", seconds);
    else if (seconds < 59.95)
        std::snprintf(text, sizeof text, "%.1f s", seconds);
    else if (seconds < 3599.5)
        std::snprintf(text, sizeof text, "%ld min %ld s", std::lround(seconds) / 60, std::lround(seconds) % 60);
    else
        std::snprintf(text, sizeof text, "%.0f h %d min", std::floor((seconds + 30) / 3600),
                      static_cast<int>(std::fmod(seconds + 30, 3600)) / 60);
    return text;
}

std::string count_text(std::uint64_t count, std::string_view singular, std::string_view plural) {
    std::string digits = std::to_string(count);
    for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, ",");
    if (count == 1) return digits + " " + std::string(singular);
    return digits + " " + (plural.empty() ? std::string(singular) + "s" : std::string(plural));
}

}  // namespace raywalk
