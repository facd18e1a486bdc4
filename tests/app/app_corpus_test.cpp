// The fuzzers' committed inputs, findings among them, keep every promise of tests/fuzz/app_targets.cpp.
#include <gtest/gtest.h>

#include "tests/fuzz/app_targets.h"
#include "tests/support/process.h"

namespace raywalk {
namespace {

// Feeds each file of the corpus; how many there are.
int feed(const char* name, void (*target)(std::string_view)) {
    int files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(RAYWALK_ROOT) / "tests/fuzz/corpus" / name)) {
        target(test::read_file(entry.path()));
        ++files;
    }
    return files;
}

TEST(AppCorpus, WalkScriptsKeepThePromises) { EXPECT_GE(feed("walk_script", fuzz::walk_script), 5); }
TEST(AppCorpus, CommandLinesKeepThePromises) { EXPECT_GE(feed("command_line", fuzz::command_line), 5); }

}  // namespace
}  // namespace raywalk
