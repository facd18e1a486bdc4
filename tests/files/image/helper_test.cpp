// The helper programs: who may be run, and that no machine is too large for them.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "helpers/image/orientation.h"
#include "tests/files/folder.h"
#include "tests/support/process.h"
#include "tracer/files/helper_program.h"
#include "tracer/files/image/helper_process.h"
#include "tracer/files/image/image.h"

namespace raywalk {
namespace {

TEST(HelperProgram, IsDistrustedWhereOthersMayChangeIt) {
    const uid_t me = geteuid(), other = me + 1;
    const gid_t group = getegid(), other_group = group + 1;
    EXPECT_EQ(distrust(me, group, 0755, me), "");
    EXPECT_EQ(distrust(0, 0, 0755, me), "");
    EXPECT_EQ(distrust(me, group, 0775, me), "");  // a group of one's own
    EXPECT_NE(distrust(other, group, 0755, me), other == 0 ? "-" : "");
    EXPECT_NE(distrust(me, group, 0757, me), "");
    EXPECT_NE(distrust(me, other_group, 0775, me), "");
    EXPECT_NE(distrust(0, group, 01777, me), "");
}

TEST(HelperProgram, AMissingOneIsNamed) {
    EXPECT_THROW(open_helper("raywalk_no_such_helper"), WorkError);
    EXPECT_THROW(open_helper("../raywalk_no_such_helper"), WorkError);
}

FloatImage grey(int width, int height) {
    return {width, height,
            std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 0.5f)};
}

// Stacks of the threads that libraries start are counted as memory of the helper.
TEST(HelperProgram, ReadsWhateverStackTheCallerHas) {
    const TestFolder folder;
    const auto file = folder.path() / "grey.exr";
    write_image(file, grey(1024, 1024));
    rlimit before{};
    getrlimit(RLIMIT_STACK, &before);
    for (const rlim_t stack : {rlim_t{1} << 20, rlim_t{64} << 20, rlim_t{1} << 30, RLIM_INFINITY}) {
        if (stack > before.rlim_max) continue;
        const rlimit other{stack, before.rlim_max};
        setrlimit(RLIMIT_STACK, &other);
        EXPECT_EQ(read_image(file, {}, {"x.scene", 1, 1, 1}).texels.at(1234), 0x808080u) << stack;
    }
    setrlimit(RLIMIT_STACK, &before);
}

// Libraries start a thread for each core that they see.
TEST(HelperCores, DoNotCountAsMemory) {
    const TestFolder folder;
    for (const auto& [name, format] : {std::pair{"a.exr", ImageFormat::exr}, std::pair{"a.tif", ImageFormat::tiff},
                                       std::pair{"a.hdr", ImageFormat::hdr}})
        for (const char* cores : {"1", "4", "16", "64"}) {
            SCOPED_TRACE(std::string(name) + " with " + cores + " cores");
            write_image(folder.path() / name, grey(512, 512));
            const std::string bytes = content_of(folder.path() / name);
            const std::filesystem::path reply = folder.path() / "reply";
            const std::string command =
                "exec env -i LD_PRELOAD=" RAYWALK_MANY_CORES " RAYWALK_CORES=" + std::string(cores) +
                " MALLOC_ARENA_MAX=1 " RAYWALK_OPENIMAGEIO " decode " + std::to_string(static_cast<int>(format)) +
                " 67108864 " + std::to_string((80 << 20) + 2 * bytes.size()) + " 268439572 10 <" +
                (folder.path() / name).string() + " >" + reply.string();
            const test::Outcome outcome = test::run({.words = {"/bin/sh", "-c", "ulimit -s 1024; " + command}});
            EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
            const std::string said = content_of(reply);
            ImageReply got;
            ASSERT_GE(said.size(), sizeof got);
            std::memcpy(&got, said.data(), sizeof got);
            EXPECT_EQ(got.status, ImageReply::done) << said.substr(sizeof got, 200);
            EXPECT_EQ(got.width, 512u);
        }
}

TEST(ImageTest, TexelsAboveOneAreCounted) {
    const TestFolder folder;
    FloatImage image = grey(8, 8);
    image.rgb[0] = 4;
    image.rgb[5] = 1.5f;
    for (const char* name : {"a.exr", "a.hdr", "a.tif"}) {
        write_image(folder.path() / name, image);
        EXPECT_EQ(read_image(folder.path() / name, {}, {"x.scene", 1, 1, 1}).clipped, 2u) << name;
    }
    write_image(folder.path() / "a.exr", grey(8, 8));
    EXPECT_EQ(read_image(folder.path() / "a.exr", {}, {"x.scene", 1, 1, 1}).clipped, 0u);
}

// What each of the eight orientations makes of   1 2   as the standard says where row 0 and column 0 are.
//                                                3 4
//                                                5 6
TEST(Orientation, BringsRowZeroToTheTop) {
    const std::vector<std::vector<std::uint32_t>> upright = {{1, 2, 3, 4, 5, 6}, {2, 1, 4, 3, 6, 5}, {6, 5, 4, 3, 2, 1},
                                                             {5, 6, 3, 4, 1, 2}, {1, 3, 5, 2, 4, 6}, {5, 3, 1, 6, 4, 2},
                                                             {6, 4, 2, 5, 3, 1}, {2, 4, 6, 1, 3, 5}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        Image image{2, 3, {1, 2, 3, 4, 5, 6}};
        turn_upright(image, orientation);
        EXPECT_EQ(image.texels, upright[static_cast<std::size_t>(orientation - 1)]) << orientation;
        EXPECT_EQ(image.width, orientation < 5 ? 2 : 3);
    }
    Image image{2, 3, {1, 2, 3, 4, 5, 6}};
    for (const int none : {-1, 0, 9, 65535}) turn_upright(image, none);
    EXPECT_EQ(image.texels, upright[0]);
}

TEST(Orientation, IsReadFromExifInEitherByteOrderAndFromNothingElse) {
    const std::vector<unsigned char> big = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0};
    const std::vector<unsigned char> little = {'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 0x12,
                                               1,   3,   0,  1, 0, 0, 0, 8, 0, 0, 0};
    EXPECT_EQ(exif_orientation(big), 6);
    EXPECT_EQ(exif_orientation(little), 8);
    for (std::size_t size = 0; size < big.size(); ++size)
        EXPECT_EQ(exif_orientation(std::span(big).first(size)), 1) << size;
    std::vector<unsigned char> far = big;
    far[4] = 0xff;
    EXPECT_EQ(exif_orientation(far), 1);
}

TEST(ImageTest, APngWithAnExifChunkIsTurnedUpright) {
    const TestFolder folder;
    FloatImage wide{3, 2, std::vector<float>(18, 0.0f)};
    for (int channel = 0; channel < 3; ++channel) wide.rgb[static_cast<std::size_t>(channel)] = 1;  // upper left
    write_image(folder.path() / "a.png", wide);
    std::string bytes = content_of(folder.path() / "a.png");
    constexpr std::size_t after_header = 33;
    const std::string to_the_right("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0", 22);
    bytes.insert(after_header, std::string("\0\0\0\x16", 4) + "eXIf" + to_the_right + "none");
    const Image turned = read_image(folder.write("b.png", bytes), {}, {"x.scene", 1, 1, 1});
    EXPECT_EQ(turned.width, 2);
    EXPECT_EQ(turned.height, 3);
    EXPECT_EQ(turned.texels, (std::vector<std::uint32_t>{0, 0xFFFFFF, 0, 0, 0, 0}));
    for (const std::size_t length : {after_header + 8, after_header + 20}) {
        const std::filesystem::path cut = folder.write("cut.png", bytes.substr(0, length));
        EXPECT_THROW(read_image(cut, {}, {"x.scene", 1, 1, 1}), InputError) << length;
    }
}

TEST(ImageTest, RadianceRowsFromTheBottomAreTurnedOver) {
    const TestFolder folder;
    FloatImage image = grey(8, 8);
    for (std::size_t i = 0; i < 24; ++i) image.rgb[i] = 0;  // the first row is black
    write_image(folder.path() / "a.hdr", image);
    std::string bytes = content_of(folder.path() / "a.hdr");
    const std::size_t at = bytes.find("-Y 8 +X 8");
    ASSERT_NE(at, std::string::npos);
    bytes[at] = '+';
    const Image turned = read_image(folder.write("b.hdr", bytes), {}, {"x.scene", 1, 1, 1});
    EXPECT_EQ(turned.texels.at(3), 0x808080u);
    EXPECT_EQ(turned.texels.at(8 * 7 + 3), 0u);
}

}  // namespace
}  // namespace raywalk
