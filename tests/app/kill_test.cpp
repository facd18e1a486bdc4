// A thousand kills of `-render` over an existing picture. Minutes, hence with the long tests.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "tests/support/process.h"

namespace raywalk {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::Process;
using test::read_file;
using test::write_file;

constexpr const char* small_scene = R"(
Viewer
geo 64 48
center 0 1 0
target 0 1 -10
up 0 1 0
fovy 60
Light
origin 2 6 -4
color WHITE
intensity 1.5
Plane
texture GridTexture FLOOR 2
normal 0 1 0
offset -1
Sphere
texture PureTexture A_BIT_MIRROR RED
center 0 1 -8
radius 1.5
)";

TEST(Kill, AThousandAtRandomMomentsLeaveTheOldPictureOrAWholeNewOne) {
    const test::TemporaryFolder folder;
    write_file(folder.path() / "room.scene", small_scene);
    const fs::path picture = folder.path() / "picture.png";
    const auto rendering = [&](const std::string& size) {
        return Process{.words = {RAYWALK_PROGRAM, "room.scene", "-render", "picture.png", "--size", size, "--quiet"},
                       .folder = folder.path()};
    };
    ASSERT_EQ(run(rendering("48x32")).exit_code, 0);
    const std::string old = read_file(picture);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run(rendering("200x150")).exit_code, 0);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
    const std::string whole_new = read_file(picture);
    ASSERT_NE(old, whole_new);

    std::mt19937 random(1000);
    int killed = 0, kept = 0, replaced = 0;
    for (int i = 0; i < 1000; ++i) {
        write_file(picture, old);
        // A little longer than a run takes, so that its last moments are among them.
        const std::chrono::duration<double> moment = std::uniform_real_distribution<double>(0, 1.2)(random) * whole;
        Process process = rendering("200x150");
        std::thread killer;
        process.started = [&](int id) {
            killer = std::thread([id, moment] {
                std::this_thread::sleep_for(moment);
                kill(id, SIGKILL);
            });
        };
        const Outcome outcome = run(process);
        killer.join();
        killed += outcome.signal == SIGKILL;
        const std::string left = read_file(picture);
        kept += left == old;
        replaced += left == whole_new;
        ASSERT_TRUE(left == old || left == whole_new) << "kill " << i << " after " << moment.count() << " s";
        ASSERT_TRUE(outcome.signal == SIGKILL || (outcome.exit_code == 0 && left == whole_new)) << "kill " << i;
    }
    const std::vector<fs::path> parts = test::parts_in(folder.path());
    for (const fs::path& part : parts) EXPECT_EQ(read_file(part), whole_new) << part;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()),
              2 + static_cast<std::ptrdiff_t>(parts.size()))
        << "something else was left behind";
    std::printf("%d runs killed in time; %d old pictures, %d new ones\n", killed, kept, replaced);
    EXPECT_GT(killed, 0);
}

}  // namespace
}  // namespace raywalk
