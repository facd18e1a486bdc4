#include "tests/bench/measure.h"

#include <algorithm>
#include <ctime>

namespace raywalk::bench {

double seconds(Clock clock) {
    timespec now{};
    clock_gettime(clock == Clock::thread_cpu    ? CLOCK_THREAD_CPUTIME_ID
                  : clock == Clock::process_cpu ? CLOCK_PROCESS_CPUTIME_ID
                                                : CLOCK_MONOTONIC,
                  &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        const double place = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
    };
    return {at(0.25), at(0.5), at(0.75)};
}

Pass timed(Clock clock, std::function<void()> work) {
    return [clock, work = std::move(work)] {
        const double start = seconds(clock);
        work();
        return seconds(clock) - start;
    };
}

std::vector<std::vector<double>> take_turns(std::span<const Pass> passes, int rounds) {
    std::vector<std::vector<double>> times(passes.size());
    for (const Pass& pass : passes) pass();
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < passes.size(); ++i) times[i].push_back(passes[i]());
    return times;
}

Spread ratio_of(std::span<const double> numerator, std::span<const double> denominator) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(numerator.size(), denominator.size()); ++i)
        ratios.push_back(numerator[i] / denominator[i]);
    return spread_of(std::move(ratios));
}

}  // namespace raywalk::bench
