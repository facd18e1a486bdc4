// The benchmark's findings as Markdown and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/ray_rates.h"

namespace raywalk::bench {

// A Markdown table, columns padded; the first row is the head. Columns but the first are right-aligned.
std::string table(const std::vector<std::vector<std::string>>& rows);

// "1.98", "0.0123", "12,345": three significant digits at least.
std::string number(double value, int decimals);
// "2.13 ± 0.04": the median, and half of what lies between the quartiles.
std::string with_spread(const Spread& spread);

// What was measured against what was wanted.
struct Goal {
    std::string name;
    double goal = 0, stretch = 0;
    bool less_is_better = false;
    std::vector<std::pair<std::string, double>> measured;  // by workload
};
std::string goals_table(const std::vector<Goal>& goals);
nlohmann::json to_json(const std::vector<Goal>& goals);

std::vector<Goal> goals_of(const std::vector<RateRow>& rows);
std::string rates_table(const std::vector<RateRow>& rows);
nlohmann::json to_json(const std::vector<RateRow>& rows);

}  // namespace raywalk::bench
