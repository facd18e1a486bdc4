#include "tests/bench/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace raywalk::bench {

std::string number(double value, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    std::string result = text;
    const std::size_t point = std::min(result.find('.'), result.size());
    const std::size_t first = result[0] == '-' ? 1 : 0;
    for (std::size_t i = point; i > first + 3; i -= 3) result.insert(i - 3, ",");
    return result;
}

std::string with_spread(const Spread& spread) {
    return number(spread.median, 2) + " ± " + number((spread.high - spread.low) / 2, 2);
}

namespace {

// Characters, not bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows.front().size(), 3);
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            const std::string padding(widths[c] - width_of(rows[r][c]), ' ');
            text += "| " + (c == 0 ? rows[r][c] + padding : padding + rows[r][c]) + " ";
        }
        text += "|\n";
        if (r > 0) continue;
        for (std::size_t c = 0; c < rows[0].size(); ++c)
            text += "|" + (c == 0 ? std::string(widths[c] + 2, '-') : std::string(widths[c] + 1, '-') + ":");
        text += "|\n";
    }
    return text;
}

std::string goals_table(const std::vector<Goal>& goals) {
    std::vector<std::vector<std::string>> rows = {
        {"measured here", "goal", "stretch", "lowest", "median", "highest", "reached by"}};
    for (const Goal& goal : goals) {
        if (goal.measured.empty()) continue;
        std::vector<double> values;
        std::size_t reached = 0;
        for (const auto& [workload, value] : goal.measured) {
            values.push_back(value);
            if (goal.less_is_better ? value <= goal.goal : value >= goal.goal) ++reached;
        }
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        const std::string sign = goal.less_is_better ? "≤ " : "≥ ";
        rows.push_back({goal.name, sign + number(goal.goal, 2), sign + number(goal.stretch, 2), number(*low, 2),
                        number(spread_of(values).median, 2), number(*high, 2),
                        std::to_string(reached) + " of " + std::to_string(values.size())});
    }
    return table(rows);
}

nlohmann::json to_json(const std::vector<Goal>& goals) {
    nlohmann::json list = nlohmann::json::array();
    for (const Goal& goal : goals) {
        nlohmann::json measured = nlohmann::json::object();
        for (const auto& [workload, value] : goal.measured) measured[workload] = value;
        list.push_back({{"name", goal.name},
                        {"goal", goal.goal},
                        {"stretch", goal.stretch},
                        {"less_is_better", goal.less_is_better},
                        {"measured", measured}});
    }
    return list;
}

std::vector<Goal> goals_of(const std::vector<RateRow>& rows) {
    std::vector<Goal> goals;
    for (const RayKind kind : ray_kinds) {
        const KindTraits& traits = traits_of(kind);
        Goal goal{.name = std::string(traits.name) + " / best Embree",
                  .goal = traits.goal,
                  .stretch = traits.stretch,
                  .measured = {}};
        for (const RateRow& row : rows)
            if (row.kind == kind) goal.measured.emplace_back(row.workload, row.best_ratio());
        goals.push_back(std::move(goal));
    }
    return goals;
}

std::string rates_table(const std::vector<RateRow>& rows) {
    std::vector<std::vector<std::string>> cells = {{"scene", "rays", "best Embree call", "Embree", "kd-tree", "BVH",
                                                    "kd-tree / Embree", "BVH / Embree", "goal",
                                                    "decided otherwise (wrong: ours, Embree)"}};
    std::string before;
    for (const RateRow& row : rows) {
        const auto most = [&](std::size_t Agreement::*count) {
            return std::to_string(std::max(row.agreement[0].*count, row.agreement[1].*count));
        };
        cells.push_back({row.workload == before ? "" : row.workload, std::string(traits_of(row.kind).name),
                         row.best_embree, number(row.embree_rate * 1e-6, 1), number(row.rate[0] * 1e-6, 1),
                         number(row.rate[1] * 1e-6, 1), with_spread(row.ratio[0]), with_spread(row.ratio[1]),
                         number(traits_of(row.kind).goal, 2),
                         most(&Agreement::different) + " (" + most(&Agreement::wrong) + ", " +
                             most(&Agreement::theirs_wrong) + ")"});
        before = row.workload;
    }
    return table(cells);
}

nlohmann::json to_json(const std::vector<RateRow>& rows) {
    nlohmann::json list = nlohmann::json::array();
    for (const RateRow& row : rows) {
        nlohmann::json entry = {{"scene", row.workload},
                                {"rays", traits_of(row.kind).name},
                                {"count", row.rays},
                                {"best_embree_call", row.best_embree},
                                {"embree_rays_per_second", row.embree_rate},
                                {"embree_calls", row.calls}};
        for (std::size_t a = 0; a < 2; ++a)
            entry[a == 0 ? "kdtree" : "bvh"] = {{"rays_per_second", row.rate[a]},
                                                {"ratio", row.ratio[a].median},
                                                {"ratio_quartiles", {row.ratio[a].low, row.ratio[a].high}},
                                                {"different_hits", row.agreement[a].different},
                                                {"wrong_hits", row.agreement[a].wrong},
                                                {"wrong_hits_of_embree", row.agreement[a].theirs_wrong}};
        list.push_back(std::move(entry));
    }
    return list;
}

}  // namespace raywalk::bench
