#include "tracer/ground/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "tests/support/process.h"
#include "tracer/ground/error.h"

namespace raywalk {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WholeFile, MakesAndReplacesFilesAndLeavesNothingElse) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "a.txt";
    write_whole(file, "one");
    EXPECT_EQ(read_file(file), "one");
    write_whole(file, std::string(100'000, 'x'));
    EXPECT_EQ(read_file(file), std::string(100'000, 'x'));
    write_whole(file, "");
    EXPECT_EQ(read_file(file), "");
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WholeFile, IsThereWhenItIsFinishedAndNotBefore) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "a.txt";
    write_file(file, "old");
    {
        WholeFile abandoned(file);
        abandoned.append("new");
    }
    EXPECT_EQ(read_file(file), "old");
    WholeFile whole(file);
    whole.append("one ");
    whole.append("two ");
    whole.append("six");
    EXPECT_EQ(whole.size(), 11u);
    whole.overwrite(4, "TWO");
    EXPECT_EQ(read_file(file), "old");
    whole.finish(Durability::in_system);
    EXPECT_EQ(read_file(file), "one TWO six");
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WholeFile, AReplacedFileKeepsItsRights) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "a.txt";
    for (const mode_t mode : {0600, 0640, 0666}) {
        write_file(file, "old");
        chmod(file.c_str(), mode);
        write_whole(file, "new");
        struct stat status {};
        ASSERT_EQ(stat(file.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777, mode);
        EXPECT_EQ(read_file(file), "new");
    }
}

TEST(WholeFile, ALinkThatLeadsNowhereYetIsFollowed) {
    const TemporaryFolder folder;
    fs::create_symlink("second", folder.path() / "first");
    fs::create_symlink(folder.path() / "target", folder.path() / "second");
    write_whole(folder.path() / "first", "new");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "first"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "second"));
    EXPECT_EQ(read_file(folder.path() / "target"), "new");
}

TEST(WholeFile, NewFilesHaveTheUsualRights) {
    const TemporaryFolder folder;
    const mode_t mask = umask(022);
    write_whole(folder.path() / "a.txt", "one");
    umask(mask);
    struct stat status {};
    ASSERT_EQ(stat((folder.path() / "a.txt").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0644u);
}

TEST(WholeFile, FollowsALinkInsteadOfReplacingIt) {
    const TemporaryFolder folder;
    write_file(folder.path() / "real.txt", "old");
    fs::create_symlink("real.txt", folder.path() / "link.txt");
    write_whole(folder.path() / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.txt"));
    EXPECT_EQ(read_file(folder.path() / "real.txt"), "new");
}

TEST(WholeFile, DevicesAreWrittenToAndTheirErrorsReported) {
    write_whole("/dev/null", "gone");
    try {
        write_whole("/dev/full", "too much");
        FAIL();
    } catch (const WorkError& error) {
        EXPECT_STREQ(error.what(), "cannot write '/dev/full': No space left on device");
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(WholeFile, FailuresNameTheFileAndLeaveNothing) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_whole(folder.path() / "missing" / "a.txt", "x"), WorkError);
    fs::create_directory(folder.path() / "b.txt");
    EXPECT_THROW(write_whole(folder.path() / "b.txt", "x"), WorkError);
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WholeFile, ObstaclesAreKnownBeforehand) {
    const TemporaryFolder folder;
    EXPECT_EQ(obstacle_to_writing(folder.path() / "a.txt"), "");
    EXPECT_EQ(obstacle_to_writing("/dev/null"), "");
    EXPECT_THAT(obstacle_to_writing(folder.path() / "missing" / "a.txt"), testing::HasSubstr("does not exist"));
    EXPECT_EQ(obstacle_to_writing(folder.path()), "it is a folder");
    write_file(folder.path() / "file", "");
    EXPECT_THAT(obstacle_to_writing(folder.path() / "file" / "a.txt"), testing::HasSubstr("is not a folder"));
    EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WholeFile, ANameMayBeAsLongAsTheSystemAllows) {
    const TemporaryFolder folder;
    const fs::path longest = folder.path() / (std::string(251, 'a') + ".png");
    EXPECT_EQ(obstacle_to_writing(longest), "");
    write_whole(longest, "whole");
    EXPECT_EQ(read_file(longest), "whole");
    EXPECT_EQ(files_in(folder.path()), 1u);
    EXPECT_EQ(obstacle_to_writing(folder.path() / (std::string(252, 'a') + ".png")), "File name too long");
}

TEST(WholeFile, ALinkThatLeadsToItselfIsAnObstacle) {
    const TemporaryFolder folder;
    fs::create_symlink("loop", folder.path() / "loop");
    EXPECT_EQ(obstacle_to_writing(folder.path() / "loop"), "Too many levels of symbolic links");
}

TEST(WholeFile, APipeThatNobodyReadsIsNotWaitedFor) {
    const TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(write_whole(pipe, "x"), WorkError);
    // More than a pipe holds, so that the writer has to wait for the reader.
    const std::string text(1'000'000, 'x');
    std::string got;
    std::thread reader([&] { got = read_file(pipe); });
    for (;;) try {
            write_whole(pipe, text);
            break;
        } catch (const WorkError&) {  // the reader is not there yet
            std::this_thread::yield();
        }
    reader.join();
    EXPECT_EQ(got, text);

    std::thread another_reader([&] { got = read_file(pipe); });
    for (bool done = false; !done;) try {
            WholeFile whole(pipe);
            whole.append("one two");
            whole.overwrite(0, "ONE");
            whole.finish();
            done = true;
        } catch (const WorkError&) {
            std::this_thread::yield();
        }
    another_reader.join();
    EXPECT_EQ(got, "ONE two");
}

}  // namespace
}  // namespace raywalk
