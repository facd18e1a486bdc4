// Every shipped scene is rendered by the program as a user would, and says nothing that would worry one.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace {

namespace fs = std::filesystem;
using namespace raywalk::test;

std::vector<fs::path> shipped_scenes() {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator(fs::path(RAYWALK_ROOT) / "scenes"))
        if (entry.path().extension() == ".scene") scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

class ShippedPicture : public testing::TestWithParam<fs::path> {};

// Small, one sample a pixel: what is tested is that it works, not how it looks.
TEST_P(ShippedPicture, IsRenderedWithoutAWarning) {
    const TemporaryFolder folder;
    const fs::path picture = folder.path() / "picture.png", stats = folder.path() / "stats.json";
    const Outcome outcome = run({.words = {RAYWALK_PROGRAM, GetParam().string(), "-render", picture.string(), "--size",
                                           "96x72", "--spp", "1", "--stats", stats.string()},
                                 .folder = folder.path()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("warning"), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_GT(fs::file_size(picture), 500u) << "an empty picture";
    EXPECT_TRUE(nlohmann::json::accept(read_file(stats)));
}

INSTANTIATE_TEST_SUITE_P(Every, ShippedPicture, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });

// In whatever way the generator was compiled: with sanitizers too.
TEST(GeneratedFile, HasTheSameBitsWhereverItIsMade) {
    const TemporaryFolder folder;
    const fs::path mesh = folder.path() / "knot.obj";
    const Outcome outcome = run({.words = {RAYWALK_GENERATOR, "knot", mesh.string()}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_TRUE(read_file(mesh) == read_file(fs::path(RAYWALK_ROOT) / "objs/knot.obj"));
}

}  // namespace
