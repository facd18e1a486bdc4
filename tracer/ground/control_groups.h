// What the control groups that this process is in allow: containers, systemd's slices, batch systems.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace raywalk {

// Cores of a quota and its period, rounded up; 0 where there is none ("max", -1, 0).
int cores_of_quota(std::string_view quota, std::string_view period);

// The least of all groups from this process's own up to the root, in either version of control groups.
class ControlGroups {
  public:
    // `root`: where the kernel's files are, "/" but for tests.
    explicit ControlGroups(std::filesystem::path root = "/");

    [[nodiscard]] int cores() const;                                 // of the quota of processor time; 0: no quota
    [[nodiscard]] std::optional<std::uint64_t> memory_left() const;  // bytes; none: no limit

  private:
    // Calls `visit` with the folders of `controller` ("cpu", "memory") from the own group up to the root.
    void visit_folders(std::string_view controller,
                       const std::function<void(const std::filesystem::path&)>& visit) const;

    std::filesystem::path root_;
    std::string membership_;  // /proc/self/cgroup
};

}  // namespace raywalk
