// The program in a folder of its own, with a small scene in it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/process.h"
#include "tracer/files/image/image.h"

namespace raywalk {

namespace fs = std::filesystem;
using test::Outcome;
using test::Process;
using test::read_file;
using test::write_file;
using testing::HasSubstr;
using testing::Not;

inline constexpr const char* small_scene = R"(
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
Light
area 3 0.5
origin -2 6 -8
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
Face
texture PureTexture PLASTIC CYAN
a -4 -1 -12
b 4 -1 -12
c 0 4 -12
)";

class CommandLine : public testing::Test {
  protected:
    CommandLine() { write_file(path("room.scene"), small_scene); }

    fs::path path(const std::string& name) const { return folder_.path() / name; }
    Process process(std::vector<std::string> words) const {
        words.insert(words.begin(), RAYWALK_PROGRAM);
        return {.words = std::move(words), .environment = {"OMP_NUM_THREADS"}, .folder = folder_.path()};
    }
    Outcome raywalk(std::vector<std::string> words) const { return run(process(std::move(words))); }
    // Renders and returns the file's bytes.
    std::string picture(std::vector<std::string> words, const std::string& name = "picture.png") const {
        words.insert(words.begin(), {"room.scene", "-render", name, "--quiet"});
        const Outcome outcome = raywalk(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        return read_file(path(name));
    }
    Image pixels(const std::string& name) const { return read_image(path(name), {}, {.file = "test"}); }
    nlohmann::json statistics(std::vector<std::string> words) const {
        words.insert(words.begin(), {"room.scene", "-render", "picture.png", "--quiet", "--stats", "-"});
        const Outcome outcome = raywalk(words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        return nlohmann::json::parse(outcome.output);
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
    }

    test::TemporaryFolder folder_;
};

inline int red(std::uint32_t texel) { return static_cast<int>(texel & 0xFF); }
inline int largest_channel(const Image& image) {
    int largest = 0;
    for (const std::uint32_t texel : image.texels)
        for (const int shift : {0, 8, 16}) largest = std::max(largest, static_cast<int>(texel >> shift & 0xFF));
    return largest;
}

}  // namespace raywalk
