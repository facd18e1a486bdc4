// The fuzzers' committed inputs, findings among them, keep every promise of tests/fuzz/targets.cpp.
#include <gtest/gtest.h>

#include <vector>

#include "tests/files/folder.h"
#include "tests/fuzz/targets.h"
#include "tracer/files/image/image.h"

namespace raywalk {
namespace {

std::vector<std::filesystem::path> corpus(const char* name) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(RAYWALK_ROOT) / "tests/fuzz/corpus" / name))
        files.push_back(entry.path());
    return files;
}

TEST(CorpusTest, ScenesKeepThePromises) {
    EXPECT_GE(corpus("scene").size(), 3u);
    for (const auto& file : corpus("scene")) fuzz::scene(content_of(file));
}

TEST(CorpusTest, MeshesKeepThePromises) {
    EXPECT_GE(corpus("obj").size(), 3u);
    for (const auto& file : corpus("obj")) fuzz::obj(content_of(file));
}

TEST(CorpusTest, ImagesAreReadOrRefused) {
    EXPECT_GE(corpus("image").size(), 10u);
    for (const auto& file : corpus("image")) {
        try {
            const Image image = read_image(file, {}, {"x.scene", 1, 1});
            EXPECT_EQ(image.texels.size(),
                      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
            EXPECT_TRUE(file.has_extension()) << file << " is a finding, and yet read";
        } catch (const InputError& error) {
            EXPECT_FALSE(file.has_extension()) << error.what();
        }
    }
}

}  // namespace
}  // namespace raywalk
