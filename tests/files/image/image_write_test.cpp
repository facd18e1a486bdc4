// Image files as another program reads them: OpenImageIO's oiiotool, which compares them with a PFM of the same
// picture. That a PFM holds the floats, as its few lines say, is tested byte by byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/files/folder.h"
#include "tests/support/process.h"
#include "tracer/files/image/image.h"

namespace raywalk {
namespace {

namespace fs = std::filesystem;

// Noise, runs of equal values, black, and floats of every size; no bits are alike by chance.
FloatImage awkward_picture(int width, int height) {
    FloatImage image{width, height, {}};
    std::uint32_t bits = 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 3 * width; ++x) {
            bits = bits * 1664525u + 1013904223u;
            const float any_size = std::bit_cast<float>((bits >> 1) % 0x7F00'0000u);
            const float usual = static_cast<float>(bits >> 8) * 0x1p-22f;
            image.rgb.push_back(x % 9 < 4 ? usual : y % 5 == 0 ? any_size : y % 5 == 1 ? 0.0f : 0.75f);
        }
    return image;
}

// What oiiotool says about a difference; empty when every float is the same.
std::string difference(const fs::path& file, const fs::path& other) {
    const test::Outcome outcome = test::run({.words = {"oiiotool", "--fail", "0", "--failpercent", "0", "--hardfail",
                                                       "0", file.string(), "--diff", other.string()}});
    return outcome.exit_code == 0 ? "" : outcome.output + outcome.errors;
}

constexpr std::pair<int, int> sizes[] = {{1, 1}, {301, 35}};
constexpr Saving savings[] = {Saving::unhurried, Saving::urgent};

class FloatFormat : public testing::TestWithParam<const char*> {};

TEST_P(FloatFormat, HoldsEveryBitUrgentOrNot) {
    const TestFolder folder;
    for (const auto& [width, height] : sizes)
        for (const Saving saving : savings) {
            const FloatImage image = awkward_picture(width, height);
            const fs::path file = folder.path() / ("a" + std::string(GetParam())), pfm = folder.path() / "a.pfm";
            write_image(file, image, saving);
            write_image(pfm, image);
            EXPECT_EQ(difference(file, pfm), "") << width << " x " << height;
        }
}

INSTANTIATE_TEST_SUITE_P(ImageWriting, FloatFormat, testing::Values(".exr", ".tif"));

TEST(ImageWriting, HdrHoldsEightBitsBelowTheExponentOfTheLargestChannel) {
    const TestFolder folder;
    for (const auto& [width, height] : sizes) {
        FloatImage image = awkward_picture(width, height);
        for (float& value : image.rgb) value = std::min(value, 0x1p40f);  // beyond, oiiotool rounds what it reads
        write_image(folder.path() / "a.hdr", image);
        for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
            const float largest = std::max({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
            const float step = largest < 1e-32f ? 0 : std::ldexp(1.0f, std::ilogb(largest) - 7);
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[i + c] = step == 0 ? 0 : std::floor(image.rgb[i + c] / step) * step;
        }
        write_image(folder.path() / "a.pfm", image);
        EXPECT_EQ(difference(folder.path() / "a.hdr", folder.path() / "a.pfm"), "") << width << " x " << height;
    }
}

TEST(ImageWriting, PngHoldsEveryByteUrgentOrNot) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 200}, {301, 130}})
        for (const Saving saving : savings) {
            std::vector<std::uint8_t> rgb;
            const auto bytes = static_cast<unsigned>(width * height * 3);
            rgb.reserve(bytes);
            for (unsigned i = 0; i < bytes; ++i) rgb.push_back(static_cast<std::uint8_t>(i % 7 < 3 ? i * i : i / 400));
            write_image(folder.path() / "a.png", width, height, rgb, saving);
            const Image image = read_image(folder.path() / "a.png", {}, {});
            ASSERT_EQ(image.texels.size() * 3, rgb.size());
            for (std::size_t i = 0; i < rgb.size(); ++i)
                ASSERT_EQ(image.texels[i / 3] >> (8 * (i % 3)) & 255, rgb[i])
                    << i << " of " << width << " x " << height;
        }
}

TEST(ImageWriting, HdrHasNoNegativeOrEndlessValues) {
    constexpr float endless = std::numeric_limits<float>::infinity(), largest = 0x1.FEp126f;
    const TestFolder folder;
    write_image(
        folder.path() / "a.hdr",
        FloatImage{3, 1, {-1, 0.5f, std::numeric_limits<float>::quiet_NaN(), endless, 0x1p127f, 0, -endless, 0, 0}});
    write_image(folder.path() / "a.pfm", FloatImage{3, 1, {0, 0.5f, 0, largest, largest, 0, 0, 0, 0}});
    EXPECT_EQ(difference(folder.path() / "a.hdr", folder.path() / "a.pfm"), "");
}

TEST(ImageWriting, PfmHoldsTheFloatsFromTheBottomRow) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 150}}) {
        const FloatImage image = awkward_picture(width, height);
        write_image(folder.path() / "a.pfm", image);
        std::string expected = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
        const auto row = static_cast<std::size_t>(width) * 3;
        for (auto y = static_cast<std::size_t>(height); y-- > 0;)
            expected.append(reinterpret_cast<const char*>(&image.rgb[y * row]), row * sizeof(float));
        EXPECT_TRUE(content_of(folder.path() / "a.pfm") == expected) << width << " x " << height;
    }
}

// The same picture is the same file, whenever it is written.
TEST(ImageWriting, NoFormatHoldsTheDate) {
    const TestFolder folder;
    std::vector<std::string> words = {"oiiotool", "--info", "-v"};
    for (const char* name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif"}) {
        words.push_back((folder.path() / name).string());
        write_image(words.back(), awkward_picture(40, 300));
    }
    const test::Outcome outcome = test::run({.words = words});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    for (const char* name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif"})
        EXPECT_THAT(outcome.output, testing::ContainsRegex(std::string(name) + " *: *40 x *300, 3 channel"));
    EXPECT_THAT(outcome.output, testing::Not(testing::HasSubstr("DateTime")));
}

class AnyFormat : public testing::TestWithParam<const char*> {
  protected:
    const TestFolder folder_;
    const fs::path file_ = folder_.path() / ("a" + std::string(GetParam()));
};

TEST_P(AnyFormat, RowsAreAskedForOnceAndAFewAtATime) {
    for (const Saving saving : savings) {
        std::vector<int> asked(1000);
        const auto read = [&](int begin, int end, float* rgb) {
            EXPECT_LE(end - begin, 64);
            for (int y = begin; y < end; ++y) ++asked[static_cast<std::size_t>(y)];
            std::fill_n(rgb, (end - begin) * 3, 0.5f);
        };
        write_image(file_, FloatRows{1, 1000, read}, saving);
        EXPECT_THAT(asked, testing::Each(1));
    }
}

TEST_P(AnyFormat, WhatGoesWrongInARowLeavesTheOldPicture) {
    test::write_file(file_, "old");
    int rows = 0;
    const auto read = [&](int begin, int end, float* rgb) {
        std::fill_n(rgb, (end - begin) * 3, 0.5f);
        rows += end - begin;
        if (rows > 300) throw std::bad_alloc();
    };
    EXPECT_THROW(write_image(file_, FloatRows{1, 1000, read}), std::bad_alloc);
    EXPECT_EQ(content_of(file_), "old");
    EXPECT_EQ(names_in(folder_.path()), 1u);
}

TEST_P(AnyFormat, GoesToADeviceToo) {
    fs::create_symlink("/dev/full", file_);
    try {
        write_image(file_, awkward_picture(3, 3));
        ADD_FAILURE() << "there is room on a full disk";
    } catch (const WorkError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("No space left on device"));
    }
    fs::remove(file_);
    fs::create_symlink("/dev/null", file_);
    write_image(file_, awkward_picture(3, 3));
}

INSTANTIATE_TEST_SUITE_P(ImageWriting, AnyFormat, testing::Values(".png", ".jpg", ".exr", ".hdr", ".tif", ".pfm"));

// A picture that nobody waits for is smaller; one that somebody waits for is not compressed.
TEST(ImageWriting, UrgentFloatsAreNotCompressed) {
    const TestFolder folder;
    const FloatImage image{512, 512, std::vector<float>(512 * 512 * 3, 0.5f)};
    for (const char* name : {"a.exr", "a.tif"}) {
        write_image(folder.path() / name, image, Saving::urgent);
        EXPECT_GT(fs::file_size(folder.path() / name), image.rgb.size() * sizeof(float)) << name;
        write_image(folder.path() / name, image, Saving::unhurried);
        EXPECT_LT(fs::file_size(folder.path() / name), image.rgb.size() * sizeof(float) / 50) << name;
    }
}

}  // namespace
}  // namespace raywalk
