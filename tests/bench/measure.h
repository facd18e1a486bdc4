// Timing that a busy machine disturbs least: contenders take turns in one process, CPU time of the thread is counted
// where one thread works, and medians of ratios are reported with their spread.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace raywalk::bench {

enum class Clock {
    thread_cpu,   // work of the calling thread only
    process_cpu,  // of one thread that need not be the calling one
    wall,         // of many threads
};
double seconds(Clock clock);

// Median and quartiles of what was measured.
struct Spread {
    double low = 0, median = 0, high = 0;
};
Spread spread_of(std::vector<double> values);

// Does its work and returns the seconds that it took.
using Pass = std::function<double()>;
Pass timed(Clock clock, std::function<void()> work);

// Runs pass 0, 1, ... in turn, `rounds` times, after one turn that is not counted. times[pass][round] in seconds.
std::vector<std::vector<double>> take_turns(std::span<const Pass> passes, int rounds);

// Of numerator[i] / denominator[i], round by round: what disturbs a round disturbs both.
Spread ratio_of(std::span<const double> numerator, std::span<const double> denominator);

}  // namespace raywalk::bench
