#include "tracer/ground/control_groups.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

namespace raywalk {

namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// The number that a text begins with; none for "max" and what is missing.
std::optional<long long> number_in(std::string_view text) {
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return {};
    return value;
}

std::optional<std::uint64_t> left_of(const fs::path& limit_file, const fs::path& usage_file) {
    const auto limit = number_in(content_of(limit_file)), used = number_in(content_of(usage_file));
    if (!limit || *limit <= 0) return {};
    return static_cast<std::uint64_t>(std::max(0LL, *limit - used.value_or(0)));
}

bool has_word(std::string_view list, std::string_view word) {
    std::istringstream words{std::string(list)};
    for (std::string one; std::getline(words, one, ',');)
        if (one == word) return true;
    return false;
}

}  // namespace

int cores_of_quota(std::string_view quota_text, std::string_view period_text) {
    const long long quota = number_in(quota_text).value_or(0), period = number_in(period_text).value_or(0);
    if (quota <= 0 || period <= 0) return 0;
    return static_cast<int>(std::min((quota - 1) / period + 1, 1LL << 20));
}

ControlGroups::ControlGroups(fs::path root)
    : root_(std::move(root)), membership_(content_of(root_ / "proc/self/cgroup")) {}

void ControlGroups::visit_folders(std::string_view controller,
                                  const std::function<void(const fs::path&)>& visit) const {
    // Lines "ID:CONTROLLERS:PATH"; version 2 has no controllers.
    std::istringstream lines(membership_);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (!controllers.empty() && !has_word(controllers, controller)) continue;
        const fs::path top = root_ / "sys/fs/cgroup" / (controllers.empty() ? "" : std::string(controller));
        // The path may be of a namespace outside, and not be there: its parents then.
        fs::path group = fs::path(line.substr(second + 1)).relative_path();
        for (;; group = group.parent_path()) {
            visit(top / group);
            if (group.empty()) break;
        }
    }
}

int ControlGroups::cores() const {
    int least = 0;
    visit_folders("cpu", [&](const fs::path& folder) {
        std::string quota = content_of(folder / "cpu.max"), period;
        if (const std::size_t blank = quota.find(' '); blank != std::string::npos)
            period = quota.substr(blank + 1);
        else {
            quota = content_of(folder / "cpu.cfs_quota_us");
            period = content_of(folder / "cpu.cfs_period_us");
        }
        if (const int cores = cores_of_quota(quota, period); cores > 0 && (least == 0 || cores < least)) least = cores;
    });
    return least;
}

std::optional<std::uint64_t> ControlGroups::memory_left() const {
    std::optional<std::uint64_t> least;
    visit_folders("memory", [&](const fs::path& folder) {
        for (const auto& left : {left_of(folder / "memory.max", folder / "memory.current"),
                                 left_of(folder / "memory.limit_in_bytes", folder / "memory.usage_in_bytes")})
            if (left && (!least || *left < *least)) least = left;
    });
    return least;
}

}  // namespace raywalk
