#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <fstream>

#include "tests/files/folder.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/sanitized.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {
namespace {

// A pattern without symmetry, and smooth, for JPEG.
std::vector<std::uint8_t> pattern_bytes(int width, int height) {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rgb.insert(rgb.end(), {static_cast<std::uint8_t>(x * 4 + y), static_cast<std::uint8_t>(y * 3),
                                   static_cast<std::uint8_t>(255 - x)});
    return rgb;
}

FloatImage pattern_floats(int width, int height) {
    FloatImage image{width, height, {}};
    for (const std::uint8_t v : pattern_bytes(width, height)) image.rgb.push_back(static_cast<float>(v) / 255.0f);
    return image;
}

// The largest difference of a channel between an image and the pattern.
int error_of(const Image& image, const std::vector<std::uint8_t>& rgb) {
    int worst = 0;
    for (std::size_t i = 0; i < image.texels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(static_cast<int>(image.texels[i] >> (8 * c) & 255) - rgb[3 * i + c]));
    return worst;
}

Image read(const std::filesystem::path& file, const Limits& limits = {}) {
    return read_image(file, limits, {"x.scene", 3, 5, 1});
}

std::string refusal_of(const std::filesystem::path& file, const Limits& limits = {}) {
    try {
        read(file, limits);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

class EveryFormat : public testing::TestWithParam<const char*> {};

TEST_P(EveryFormat, GivesBackTheBytesThatWereWritten) {
    const TestFolder folder;
    const auto file = folder.path() / ("picture" + std::string(GetParam()));
    const int width = 37, height = 70;  // more than one band of rows, and no round number
    const auto rgb = pattern_bytes(width, height);
    write_image(file, width, height, rgb);
    EXPECT_EQ(names_in(folder.path()), 1u);
    const Image image = read(file);
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    const bool jpeg = std::string(GetParam()).starts_with(".j"), hdr = std::string(GetParam()) == ".hdr";
    EXPECT_LE(error_of(image, rgb), jpeg ? 8 : hdr ? 2 : 0);  // JPEG loses detail, HDR has 8 bits below an exponent
}

TEST_P(EveryFormat, IsWrittenFromFloatsToo) {
    const TestFolder folder;
    const auto file = folder.path() / ("picture" + std::string(GetParam()));
    write_image(file, pattern_floats(16, 16));
    const bool jpeg = std::string(GetParam()).starts_with(".j"), hdr = std::string(GetParam()) == ".hdr";
    EXPECT_LE(error_of(read(file), pattern_bytes(16, 16)), jpeg ? 8 : hdr ? 2 : 0);
}

INSTANTIATE_TEST_SUITE_P(Image, EveryFormat, testing::Values(".png", ".PNG", ".jpg", ".jpeg", ".exr", ".hdr", ".tif"));

TEST(ImageTest, PfmHoldsTheFloatsBottomRowFirst) {
    const TestFolder folder;
    const auto file = folder.path() / "picture.pfm";
    const FloatImage image{2, 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 1e-30f, 1e30f, -14, 15, 16, 17}};
    write_image(file, image);
    const std::string bytes = content_of(file), header = "PF\n2 3\n-1.0\n";
    ASSERT_EQ(bytes.size(), header.size() + 72);
    EXPECT_EQ(bytes.substr(0, header.size()), header);
    for (int y = 0; y < 3; ++y)
        EXPECT_EQ(bytes.substr(header.size() + 24 * y, 24),
                  std::string(reinterpret_cast<const char*>(&image.rgb[6 * (2 - y)]), 24))
            << y;
}

TEST(ImageTest, FloatsBeyondTheDisplayAreClampedAndNaNIsBlack) {
    const TestFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const FloatImage image{2, 1, {-1, 7, nan, infinity, -infinity, 0.5f}};
    for (const char* name : {"a.exr", "a.tif", "a.png"}) {
        write_image(folder.path() / name, image);
        const Image got = read(folder.path() / name);
        EXPECT_EQ(got.texels[0], 0x0000FF00u) << name;
        EXPECT_EQ(got.texels[1], 0x008000FFu) << name;
    }
}

TEST(ImageTest, ContentDecidesTheFormatNotTheName) {
    const TestFolder folder;
    write_image(folder.path() / "a.png", 8, 8, pattern_bytes(8, 8));
    std::filesystem::rename(folder.path() / "a.png", folder.path() / "a.jpg");
    EXPECT_EQ(error_of(read(folder.path() / "a.jpg"), pattern_bytes(8, 8)), 0);
}

TEST(ImageTest, OtherFormatsAreRefused) {
    const TestFolder folder;
    for (const char* content : {"", "P6\n1 1\n255\nabc", "GIF89a", "BM______", "RIFF____WEBP", "not an image"}) {
        const std::string text = refusal_of(folder.write("a.png", content));
        EXPECT_NE(text.find("x.scene:3:5: error: image"), std::string::npos) << text;
        EXPECT_NE(text.find("expected a PNG, JPEG, TIFF, EXR or HDR file"), std::string::npos) << text;
    }
}

TEST_P(EveryFormat, TruncatedOrDamagedIsRefusedOrReadButNeverCrashes) {
    const TestFolder folder;
    const auto file = folder.path() / ("a" + std::string(GetParam()));
    write_image(file, 64, 64, pattern_bytes(64, 64));
    const std::string whole = content_of(file);
    const bool light = std::string(GetParam()).starts_with(".j") || std::string(GetParam()).starts_with(".p");
    const std::size_t cuts = light ? 40 : 2;  // the other formats' decoder takes long to start
    for (std::size_t cut = 0; cut < whole.size(); cut += 1 + whole.size() / cuts) {
        refusal_of(folder.write("cut", whole.substr(0, cut)));
        std::string damaged = whole;
        for (std::size_t i = cut; i < std::min(cut + 4, damaged.size()); ++i) damaged[i] = static_cast<char>(0xFF);
        refusal_of(folder.write("damaged", damaged));
    }
    EXPECT_NE(refusal_of(folder.write("cut", whole.substr(0, 12))), "read");
}

// A PNG whose header promises width x height pixels and that ends there.
std::string png_header(std::uint32_t width, std::uint32_t height) {
    std::string png = "\x89PNG\r\n\x1A\n";
    const auto chunk = [&](std::string_view body) {
        std::uint32_t crc = 0xFFFFFFFF;
        for (const char c : body) {
            crc ^= static_cast<unsigned char>(c);
            for (int i = 0; i < 8; ++i) crc = crc & 1 ? 0xEDB88320 ^ crc >> 1 : crc >> 1;
        }
        const auto big_endian = [&](std::uint32_t v) {
            for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(v >> shift & 255);
        };
        big_endian(static_cast<std::uint32_t>(body.size() - 4));
        png += body;
        big_endian(~crc);
    };
    std::string header = "IHDR";
    for (const std::uint32_t v : {width, height})
        for (int shift = 24; shift >= 0; shift -= 8) header += static_cast<char>(v >> shift & 255);
    chunk(header + std::string("\x08\x02\0\0\0", 5));
    chunk("IDAT");
    chunk("IEND");
    return png;
}

TEST(ImageTest, AHeaderThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
    const TestFolder folder;
    const std::string huge = refusal_of(folder.write("a.png", png_header(60000, 60000)));
    EXPECT_NE(huge.find("60000 x 60000"), std::string::npos) << huge;
    EXPECT_NE(huge.find("more than so small a file can hold"), std::string::npos) << huge;
    const std::string dense = refusal_of(folder.write("b.png", png_header(8000, 8000)));
    EXPECT_NE(dense.find("save it smaller, or with less compression"), std::string::npos) << dense;

    write_image(folder.path() / "c.png", 100, 100, pattern_bytes(100, 100));
    Limits limits;
    limits.image_pixels = 9999;
    const std::string small = refusal_of(folder.path() / "c.png", limits);
    EXPECT_NE(small.find("the limit is 9999; raise it with --max-image-pixels N"), std::string::npos) << small;
    limits.image_pixels = 10000;
    EXPECT_EQ(refusal_of(folder.path() / "c.png", limits), "read");
    limits.image_bytes = 10;
    EXPECT_NE(refusal_of(folder.path() / "c.png", limits).find("--max-image-bytes"), std::string::npos);
}

TEST_P(EveryFormat, MostlyHolesIsRefusedUnread) {
    const TestFolder folder;
    const auto file = folder.path() / ("a" + std::string(GetParam()));
    write_image(file, 64, 64, pattern_bytes(64, 64));
    std::filesystem::resize_file(file, 900u << 20);
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    const std::string text = refusal_of(file);
    getrusage(RUSAGE_SELF, &after);
    EXPECT_NE(text.find("has 943718400 bytes, but only "), std::string::npos) << text;
    EXPECT_NE(text.find("cp --sparse=never"), std::string::npos) << text;
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 << 10);  // KB
    std::filesystem::resize_file(file, std::uintmax_t{4} << 30);
    EXPECT_NE(refusal_of(file).find("has 4294967296 bytes"), std::string::npos);
}

// A text of 240 MB in the header of a file of 16 KB, which could hold a picture that may take as much; this one is
// small.
TEST(ImageTest, MemoryIsThatOfThePixelsThatAPictureClaims) {
    using namespace std::string_literals;
    const TestFolder folder;
    write_image(folder.path() / "a.exr", 64, 64, pattern_bytes(64, 64));
    std::string exr = content_of(folder.path() / "a.exr");
    const std::uint32_t size = 240u << 20;
    exr.insert(8, "about\0string\0"s + std::string(reinterpret_cast<const char*>(&size), sizeof size));
    exr.resize(16'384);
    const std::string text = refusal_of(folder.write("a.exr", exr));
    EXPECT_NE(text, "read");
    if (RAYWALK_SANITIZED) return;  // memory has no limits there
    EXPECT_NE(text.find("it needs too much memory"), std::string::npos) << text;
}

TEST(ImageTest, AJpegOfHundredsOfScansIsRefused) {
    const TestFolder folder;
    const std::string jpeg = content_of(RAYWALK_ROOT "/tests/fuzz/corpus/image/progressive.jpg");
    const std::size_t scan = jpeg.find("\xFF\xDA");  // the first one, up to the next scan or its table
    const std::size_t end = std::min(jpeg.find("\xFF\xDA", scan + 2), jpeg.find("\xFF\xC4", scan));
    ASSERT_LT(end, jpeg.size());
    const auto with_scans_more = [&](int more) {
        std::string bytes = jpeg.substr(0, end);
        for (int i = 0; i < more; ++i) bytes += jpeg.substr(scan, end - scan);
        return folder.write("a.jpg", bytes + jpeg.substr(end));
    };
    EXPECT_EQ(refusal_of(with_scans_more(0)), "read");
    EXPECT_EQ(refusal_of(with_scans_more(50)), "read");
    EXPECT_NE(refusal_of(with_scans_more(200)).find("it has more than 100 scans"), std::string::npos);
    EXPECT_NE(refusal_of(with_scans_more(20'000)).find("it has more than 100 scans"), std::string::npos);
}

// As cp makes them of long stretches of zeros.
TEST(ImageTest, AFewHolesAreNoFault) {
    const TestFolder folder;
    const int side = 1100;  // 14 MB
    write_image(folder.path() / "a.tif", FloatImage{side, side, std::vector<float>(side * side * 3)}, Saving::urgent);
    const std::string bytes = content_of(folder.path() / "a.tif");
    constexpr std::size_t block = 4096;
    const auto file = folder.write("b.tif", "");
    std::filesystem::resize_file(file, bytes.size());
    std::fstream copy(file, std::ios::in | std::ios::out | std::ios::binary);
    int holes = 0;
    for (std::size_t at = 0; at < bytes.size(); at += block) {
        const std::string_view piece = std::string_view(bytes).substr(at, block);
        if (piece.find_first_not_of('\0') == std::string_view::npos)
            ++holes;
        else
            copy.seekp(static_cast<std::streamoff>(at)).write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
    copy.close();
    EXPECT_GT(holes, 3000);
    EXPECT_EQ(content_of(file), bytes);
    EXPECT_EQ(refusal_of(file), "read");
}

TEST(ImageTest, WhatIsNoRegularFileIsRefusedAtOnce) {
    const TestFolder folder;
    const auto pipe = folder.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_NE(refusal_of(pipe).find("is a pipe"), std::string::npos);
    EXPECT_NE(refusal_of(folder.path()).find("is a folder"), std::string::npos);
    EXPECT_NE(refusal_of("/dev/zero").find("is a device"), std::string::npos);
    EXPECT_NE(refusal_of(folder.path() / "none").find("No such file or directory"), std::string::npos);
}

// --- writing ---

template <class Work>
std::string failure_of(const Work& work) {
    try {
        work();
    } catch (const WorkError& error) {
        return error.what();
    }
    return "done";
}

TEST(ImageTest, AnUnknownExtensionIsNamed) {
    const std::string text = failure_of([] { write_image("picture.bmp", FloatImage{1, 1, {0, 0, 0}}); });
    EXPECT_NE(text.find("picture.bmp"), std::string::npos) << text;
    EXPECT_FALSE(is_image_extension("a.bmp"));
    EXPECT_TRUE(is_image_extension("a.b.EXR"));
    EXPECT_TRUE(is_float_extension("a.tif"));
    EXPECT_FALSE(is_float_extension("a.png"));
}

TEST(ImageTest, AMissingFolderIsTheSystemsReason) {
    const TestFolder folder;
    for (const char* name : {"none/a.png", "none/a.pfm", "none/a.exr"}) {
        const std::string text = failure_of([&] { write_image(folder.path() / name, FloatImage{1, 1, {0, 0, 0}}); });
        EXPECT_NE(text.find("No such file or directory"), std::string::npos) << text;
    }
    EXPECT_EQ(names_in(folder.path()), 0u);
}

TEST(ImageTest, ANameThatIsAFolderStaysOne) {
    const TestFolder folder;
    std::filesystem::create_directory(folder.path() / "a.png");
    EXPECT_NE(failure_of([&] { write_image(folder.path() / "a.png", FloatImage{1, 1, {0, 0, 0}}); }), "done");
    EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a.png"));
    EXPECT_EQ(names_in(folder.path()), 1u);
}

TEST(ImageTest, AFullDiskLeavesTheOldPictureAndNothingElse) {
    const TestFolder folder;
    for (const char* name : {"a.png", "a.jpg", "a.exr", "a.pfm", "a.hdr", "a.tif"}) {
        const auto file = folder.write(name, "the old picture");
        FloatImage noise{300, 300, {}};
        for (int i = 0; i < 3 * 300 * 300; ++i)
            noise.rgb.push_back(static_cast<float>(static_cast<unsigned>(i) * 2654435761u >> 8) * 0x1p-24f);
        std::string text;
        {
            // Files may grow to 8 KiB only, which fails as a full disk does: in the middle of the writing.
            rlimit old{};
            getrlimit(RLIMIT_FSIZE, &old);
            const auto handler = std::signal(SIGXFSZ, SIG_IGN);
            const rlimit small{8192, old.rlim_max};
            setrlimit(RLIMIT_FSIZE, &small);
            text = failure_of([&] { write_image(file, noise); });
            setrlimit(RLIMIT_FSIZE, &old);
            std::signal(SIGXFSZ, handler);
        }
        EXPECT_NE(text.find("File too large"), std::string::npos) << text;
        EXPECT_TRUE(content_of(file) == "the old picture") << name;
        EXPECT_EQ(names_in(folder.path()), 1u) << name;
        std::filesystem::remove(file);
    }
}

TEST(ImageTest, WritingThroughALinkKeepsTheLink) {
    const TestFolder folder;
    const auto file = folder.write("real.pfm", "old");
    std::filesystem::create_symlink("real.pfm", folder.path() / "link.pfm");
    write_image(folder.path() / "link.pfm", FloatImage{1, 1, {0, 0, 0}});
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.pfm"));
    EXPECT_EQ(content_of(file).substr(0, 2), "PF");
}

TEST(ImageTest, ADeviceIsWrittenToNotReplaced) {
    EXPECT_NE(failure_of([] { write_whole("/dev/full", "text"); }).find("No space left on device"), std::string::npos);
    write_whole("/dev/null", "text");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace raywalk
