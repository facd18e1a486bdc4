// The fuzzers' committed inputs, findings among them, keep every promise of tests/fuzz/targets.cpp.
#include <gtest/gtest.h>

#include <utility>

#include "tests/description_folder.h"
#include "tests/fuzz/targets.h"

namespace raywalk {
namespace {

TEST(CorpusTest, EveryCommittedInputKeepsThePromises) {
    const std::pair<const char*, void (*)(std::string_view)> targets[] = {
        {"scene", fuzz::scene}, {"obj", fuzz::obj}, {"image", fuzz::image}};
    for (const auto& [name, target] : targets) {
        int inputs = 0;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(RAYWALK_ROOT) / "tests/fuzz/corpus" / name)) {
            SCOPED_TRACE(entry.path());
            target(content_of(entry.path()));
            ++inputs;
        }
        EXPECT_GE(inputs, 3) << name;
    }
}

}  // namespace
}  // namespace raywalk
