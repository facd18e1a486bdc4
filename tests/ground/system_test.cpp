// What the system allows this process, and files of a folder that may change meanwhile.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>

#include "tests/files/folder.h"
#include "tracer/ground/control_groups.h"
#include "tracer/ground/memory_left.h"
#include "tracer/ground/open_beneath.h"

namespace raywalk {
namespace {

namespace fs = std::filesystem;

TEST(ControlGroups, AQuotaIsRoundedUp) {
    EXPECT_EQ(cores_of_quota("200000", "100000"), 2);
    EXPECT_EQ(cores_of_quota("150000", "100000\n"), 2);
    EXPECT_EQ(cores_of_quota("1000", "100000"), 1);
    for (const char* quota : {"max", "", "x", "-1", "0"}) EXPECT_EQ(cores_of_quota(quota, "100000"), 0) << quota;
    for (const char* period : {"", "0", "-5"}) EXPECT_EQ(cores_of_quota("100000", period), 0) << period;
}

TEST(ControlGroups, TheLeastOfVersionTwoCountsUpToTheRoot) {
    const TestFolder root;
    root.write("proc/self/cgroup", "0::/a/b\n");
    EXPECT_EQ(ControlGroups(root.path()).cores(), 0);
    EXPECT_EQ(ControlGroups(root.path()).memory_left(), std::nullopt);
    root.write("sys/fs/cgroup/a/b/cpu.max", "max 100000\n");
    root.write("sys/fs/cgroup/a/cpu.max", "300000 100000\n");
    root.write("sys/fs/cgroup/a/b/memory.max", "5000\n");
    root.write("sys/fs/cgroup/a/b/memory.current", "1000\n");
    root.write("sys/fs/cgroup/a/memory.max", "max\n");
    EXPECT_EQ(ControlGroups(root.path()).cores(), 3);
    EXPECT_EQ(ControlGroups(root.path()).memory_left(), 4000u);
    root.write("sys/fs/cgroup/memory.max", "2000\n");  // of a container, whose own group this is
    root.write("sys/fs/cgroup/cpu.max", "50000 100000\n");
    EXPECT_EQ(ControlGroups(root.path()).cores(), 1);
    EXPECT_EQ(ControlGroups(root.path()).memory_left(), 2000u);
}

TEST(ControlGroups, VersionOneIsReadAsVersionTwo) {
    const TestFolder root;
    root.write("proc/self/cgroup", "7:cpuset:/x\n5:cpu,cpuacct:/docker/1\n3:memory:/docker/1\n");
    root.write("sys/fs/cgroup/cpu/docker/1/cpu.cfs_quota_us", "-1\n");
    root.write("sys/fs/cgroup/cpu/docker/1/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(ControlGroups(root.path()).cores(), 0);
    root.write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "250000\n");
    root.write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
    root.write("sys/fs/cgroup/memory/docker/1/memory.limit_in_bytes", "1000\n");
    root.write("sys/fs/cgroup/memory/docker/1/memory.usage_in_bytes", "3000\n");
    EXPECT_EQ(ControlGroups(root.path()).cores(), 3);
    EXPECT_EQ(ControlGroups(root.path()).memory_left(), 0u);
}

TEST(MemoryLeft, IsSomethingOnThisMachine) { EXPECT_GT(memory_left(), 1u << 20); }

TEST(OpenBeneath, NoLinkIsFollowedOnTheWay) {
    const TestFolder folder, other;
    other.write("secret", "x");
    folder.write("a/b/file", "x");
    fs::create_symlink(other.path(), folder.path() / "a/away");
    fs::create_symlink(other.path() / "secret", folder.path() / "a/b/link");
    fs::create_symlink("file", folder.path() / "a/b/near");
    const Descriptor root(open(folder.path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (const auto open_one : {open_beneath, open_by_components}) {
        EXPECT_TRUE(open_one(root, "a/b/file").valid());
        for (const char* name :
             {"a/away/secret", "a/b/link", "a/b/near", "a/../../" /* beyond it */, "a/b/none", "/etc/passwd"})
            EXPECT_FALSE(open_one(root, name).valid()) << name;
        EXPECT_FALSE(open_one(root, "a/b/link").valid());
        EXPECT_EQ(errno, ELOOP);
    }
}

}  // namespace
}  // namespace raywalk
