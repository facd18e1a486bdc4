// How far a long work is, on stderr: a bar that is redrawn on a terminal, a plain line per 10 % elsewhere.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace raywalk {

// "[#######---------]  45 %, 12.3 s left", exactly `columns` wide at most; without the bar where there is no room.
// `fraction` in [0, 1]; the remaining time is left out until something is done.
std::string progress_line(double fraction, double elapsed_seconds, int columns);

// The time that a work took without its pauses (Ctrl-Z, a suspended laptop), from the intervals between looks at it.
class WorkingTime {
  public:
    enum class Step { worked, paused };
    // Adds an interval; one far longer than the usual tenth of a second was a pause and does not count.
    Step step(double seconds);
    [[nodiscard]] double seconds() const { return seconds_; }

  private:
    double seconds_ = 0;
};

class Progress {
  public:
    enum class Style { silent, lines, bar };
    // The style for stderr: silent when quiet, else a bar on a terminal, else lines.
    static Style style_for(bool quiet);

    Progress(Style style, std::uint64_t total);
    ~Progress() { finish(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Ends the display: a bar is wiped off, lines go on to 100 % if the work is complete. Only the first call counts.
    void finish();

    // From any thread.
    void advance(std::uint64_t amount = 1) { done_.fetch_add(amount, std::memory_order_relaxed); }

  private:
    void run(const std::stop_token& stop);
    void show();
    [[nodiscard]] double fraction() const;
    double elapsed();  // seconds of work, without pauses

    Style style_;
    std::uint64_t total_;
    std::atomic<std::uint64_t> done_ = 0;
    std::chrono::steady_clock::time_point last_look_;
    WorkingTime working_;
    int tenths_shown_ = 0;
    std::string line_shown_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;
};

}  // namespace raywalk
