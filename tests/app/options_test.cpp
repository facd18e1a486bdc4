#include "app/command_line/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tracer/kernels/kernels.h"

namespace raywalk {
namespace {

using testing::HasSubstr;
using testing::Not;

Options parsed(const std::vector<std::string>& words) { return std::get<Options>(parse_command_line(words)); }

std::string error_of(const std::vector<std::string>& words) {
    try {
        parse_command_line(words);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Options, ASceneAloneIsAWalk) {
    const Options options = parsed({"a.scene"});
    EXPECT_EQ(options.mode, Mode::travel);
    EXPECT_EQ(options.scene, "a.scene");
    EXPECT_FALSE(options.size || options.samples_per_pixel || options.projection || options.exposure || options.stats);
    EXPECT_EQ(options.seed, 0u);
    EXPECT_GE(options.threads, 1);
}

TEST(Options, TheReportsSpellingsAndTheUsualOnesMeanTheSame) {
    EXPECT_EQ(parsed({"a.scene", "-travel"}).mode, Mode::travel);
    EXPECT_EQ(parsed({"--travel", "a.scene"}).mode, Mode::travel);
    for (const std::vector<std::string>& words : {std::vector<std::string>{"a.scene", "-render", "b.png"},
                                                  {"a.scene", "--render", "b.png"},
                                                  {"--render=b.png", "a.scene"},
                                                  {"-render=b.png", "a.scene"}}) {
        EXPECT_EQ(parsed(words).mode, Mode::render);
        EXPECT_EQ(parsed(words).output, "b.png");
        EXPECT_EQ(parsed(words).scene, "a.scene");
    }
}

TEST(Options, EveryOptionReachesItsValue) {
    const Options options = parsed({"a.scene",
                                    "--capture",
                                    "b.png",
                                    "--size",
                                    "640x480",
                                    "--spp",
                                    "16",
                                    "--projection",
                                    "orthographic",
                                    "--exposure",
                                    "1.5",
                                    "--seed",
                                    "4294967295",
                                    "--threads",
                                    "3",
                                    "--keys",
                                    "2w",
                                    "--frames",
                                    "f-%04d.png",
                                    "--stats",
                                    "-",
                                    "--verbose",
                                    "--accelerator",
                                    "kdtree",
                                    "--leaf-limit",
                                    "8",
                                    "--depth-limit",
                                    "50",
                                    "--traversal-cost",
                                    "0.75",
                                    "--intersection-cost",
                                    "2",
                                    "--max-triangles",
                                    "12",
                                    "--allow-path",
                                    "/a",
                                    "--allow-path",
                                    "/b"});
    EXPECT_EQ(options.mode, Mode::capture);
    EXPECT_EQ(options.output, "b.png");
    EXPECT_EQ(options.size, glm::ivec2(640, 480));
    EXPECT_EQ(options.samples_per_pixel, 16u);
    EXPECT_EQ(options.projection, Projection::orthographic);
    EXPECT_EQ(options.exposure, Exposure{1.5f});
    EXPECT_EQ(options.seed, 4294967295u);
    EXPECT_EQ(options.threads, 3);
    EXPECT_EQ(options.keys, (WalkScript{WalkKey::forward, WalkKey::forward}));
    EXPECT_EQ(options.frames, "f-%04d.png");
    EXPECT_EQ(options.stats, "-");
    EXPECT_EQ(options.verbosity, Verbosity::verbose);
    EXPECT_EQ(options.compile.accelerator, Accelerator::kdtree);
    EXPECT_EQ(options.compile.kd.leaf_limit, 8);
    EXPECT_EQ(options.compile.kd.depth_limit, 50);
    EXPECT_EQ(options.compile.kd.traversal_cost, 0.75f);
    EXPECT_EQ(options.compile.kd.intersection_cost, 2);
    EXPECT_EQ(options.limits.triangles, 12u);
    EXPECT_EQ(options.limits.allowed_folders, (std::vector<std::filesystem::path>{"/a", "/b"}));
}

TEST(Options, ValuesFollowAnEqualsSignToo) {
    EXPECT_EQ(parsed({"a.scene", "--size=8x4"}).size, glm::ivec2(8, 4));
    EXPECT_EQ(parsed({"a.scene", "--exposure=normalize"}).exposure, Exposure{});
    EXPECT_EQ(parsed({"a.scene", "--accelerator=bvh"}).compile.accelerator, Accelerator::bvh);
    EXPECT_EQ(parsed({"a.scene", "--check", "-q"}).verbosity, Verbosity::quiet);
}

TEST(Options, ADoubleDashEndsTheOptions) { EXPECT_EQ(parsed({"--", "-a.scene"}).scene, "-a.scene"); }

TEST(Options, EveryLimitCanBeRaised) {
    for (const LimitOption& option : limit_options) {
        const Options options = parsed({"a.scene", std::string(option.name), std::to_string(option.most)});
        EXPECT_EQ(options.limits.*option.value, option.most) << option.name;
        EXPECT_THAT(error_of({"a.scene", std::string(option.name), std::to_string(option.most + 1)}),
                    HasSubstr("a whole number from 1 to"));
    }
}

TEST(Options, EveryInstructionSetOfThisMachineCanBeChosen) {
    ASSERT_FALSE(available_kernels().empty());
    for (const Kernels* kernels : available_kernels())
        EXPECT_EQ(parsed({"a.scene", "--isa", std::string(kernels->name)}).isa, kernels->name);
    EXPECT_THAT(error_of({"a.scene", "--isa", "abacus"}), HasSubstr("this processor has no 'abacus', but "));
}

TEST(Options, ASlipIsRecognised) {
    EXPECT_EQ(error_of({"a.scene", "--exposre", "2"}), "unknown option '--exposre': did you mean '--exposure'?");
    EXPECT_EQ(error_of({"a.scene", "--rendr=x.png"}), "unknown option '--rendr': did you mean '--render'?");
    EXPECT_EQ(error_of({"a.scene", "-x"}), "unknown option '-x'");
    EXPECT_EQ(error_of({"a.scene", "-size", "4x4"}), "unknown option '-size': did you mean '--size'?");
    for (const char* word : {"-vx", "-verbos", "---size", "-1", "-=x"})
        EXPECT_THAT(error_of({"a.scene", word}), HasSubstr("unknown option '-")) << word;
    EXPECT_THAT(error_of({"a.scene", "-vx"}), HasSubstr("'-vx'"));
    EXPECT_EQ(error_of({"--sise", "4x4"}), "unknown option '--sise': did you mean '--size'?");
}

TEST(Options, OneOfAFewWordsIsAskedForByAllOfThem) {
    EXPECT_EQ(error_of({"a.scene", "--accelerator", "octree"}),
              "--accelerator: expected one of kdtree, bvh, not 'octree': did you mean 'kdtree'?");
    EXPECT_EQ(error_of({"a.scene", "--accelerator", "grid"}), "--accelerator: expected one of kdtree, bvh, not 'grid'");
    EXPECT_THAT(error_of({"a.scene", "--projection", "ortographic"}), HasSubstr("did you mean 'orthographic'?"));
}

TEST(Options, WhatIsMissingIsNamed) {
    EXPECT_THAT(error_of({}), HasSubstr("which scene?"));
    EXPECT_THAT(error_of({"-render", "a.png"}), HasSubstr("which scene?"));
    EXPECT_THAT(error_of({""}), HasSubstr("which scene?"));
    EXPECT_THAT(error_of({"a.scene", "-render"}),
                HasSubstr("--render needs a value: --render OUT, such as picture.png"));
    EXPECT_THAT(error_of({"a.scene", "--size", "--spp", "4"}), HasSubstr("--size needs a value: --size WxH"));
    EXPECT_THAT(error_of({"a.scene", "--size", "-render", "a.png"}), HasSubstr("--size needs a value"));
}

TEST(Options, WhatIsTooMuchIsNamed) {
    EXPECT_THAT(error_of({"a.scene", "b.scene"}), HasSubstr("one scene at a time: what is 'b.scene' for?"));
    EXPECT_EQ(error_of({"a.scene", "--spp", "1", "--spp", "2"}), "--spp is given twice");
    EXPECT_EQ(error_of({"a.scene", "--check", "--check"}), "--check is given twice");
    EXPECT_EQ(error_of({"a.scene", "--check=yes"}), "--check takes no value");
    EXPECT_EQ(error_of({"a.scene", "--quiet="}), "--quiet takes no value");
    EXPECT_THAT(error_of({"a.scene", "--", "--size"}), HasSubstr("what is '--size' for?"));
    EXPECT_THAT(error_of({"a.scene", "--allow-path", "b", "c.scene"}), HasSubstr("what is 'c.scene' for?"));
}

TEST(Options, WrongValuesAreToldWhatIsExpected) {
    for (const char* size :
         {"12", "x", "0x4", "4x0", "-4x4", "4x", "x4", "16385x1", "4x4x4", "4 x4", "99999999999x1", ""})
        EXPECT_THAT(error_of({"a.scene", "--size", size}), HasSubstr("expected WIDTHxHEIGHT in pixels")) << size;
    for (const char* count : {"0", "-1", "1.5", "many", "99999999999", "16777217", "", " 1"})
        EXPECT_THAT(error_of({"a.scene", "--spp", count}), HasSubstr("expected a whole number from 1 to 16777216"))
            << count;
    EXPECT_THAT(error_of({"a.scene", "--size="}), HasSubstr("WIDTHxHEIGHT in pixels"));
    EXPECT_EQ(parsed({"a.scene", "--seed", "010"}).seed, 10u);  // not octal
    for (const char* value : {"0", "-1", "inf", "nan", "1e-45", "bright", "", "1.5x"})
        EXPECT_THAT(error_of({"a.scene", "--exposure", value}), HasSubstr("'normalize' or a number above 0")) << value;
    EXPECT_THAT(error_of({"a.scene", "--seed", "4294967296"}), HasSubstr("from 0 to 4294967295"));
    EXPECT_THAT(error_of({"a.scene", "--threads", "0"}), HasSubstr("from 1 to 1024"));
    EXPECT_THAT(error_of({"a.scene", "--leaf-limit", "0"}), HasSubstr("from 1 to 1024"));
    EXPECT_THAT(error_of({"a.scene", "--depth-limit", "101"}), HasSubstr("from 1 to 100"));
    EXPECT_THAT(error_of({"a.scene", "--traversal-cost", "-1"}), HasSubstr("a number above 0"));
    EXPECT_THROW(parse_command_line({"a.scene", "--keys", "3x"}), InputError);
}

TEST(Options, ThePicturesNameMustSayItsFormat) {
    for (const char* name : {"a.png", "a.PNG", "a.jpg", "a.jpeg", "a.exr", "a.pfm", "a.hdr", "a.tif", "a.tiff"})
        EXPECT_EQ(parsed({"a.scene", "-render", name}).output, name);
    EXPECT_THAT(error_of({"a.scene", "-render", "a.gif"}), HasSubstr("unknown kind of picture '.gif'"));
    EXPECT_THAT(error_of({"a.scene", "-render", "picture"}), HasSubstr("the name has no extension"));
    EXPECT_THAT(error_of({"a.scene", "--capture", "a.txt"}), HasSubstr("unknown kind of picture '.txt'"));
}

TEST(Options, ContradictionsAreExplained) {
    EXPECT_THAT(error_of({"a.scene", "-render", "a.png", "--capture", "b.png"}),
                HasSubstr("--render excludes --capture: choose one of them"));
    EXPECT_THAT(error_of({"a.scene", "-travel", "--check"}),
                HasSubstr("--travel excludes --check: choose one of them"));
    EXPECT_THAT(error_of({"a.scene", "--quiet", "-v"}), HasSubstr("--quiet excludes --verbose: choose one of them"));
    EXPECT_THAT(error_of({"a.scene", "--frames", "a-%d.png"}), HasSubstr("--frames requires --capture"));
    EXPECT_THAT(error_of({"a.scene", "--capture", "a.png", "--frames", "a-%d.png"}), HasSubstr("add --keys SCRIPT"));
    EXPECT_THAT(error_of({"a.scene", "--check", "--stats", "-"}), HasSubstr("--check makes none"));
    EXPECT_THAT(error_of({"a.scene", "--accelerator", "bvh", "--leaf-limit", "4"}), HasSubstr("--accelerator kdtree"));
    EXPECT_EQ(parsed({"a.scene", "--leaf-limit", "4"}).compile.accelerator, Accelerator::kdtree);
    EXPECT_EQ(parsed({"a.scene"}).compile.accelerator, Accelerator::bvh);
}

TEST(Options, AFramePatternHasOneNumber) {
    const auto with = [](const char* pattern) {
        return std::vector<std::string>{"a.scene", "--capture", "a.png", "--keys", "w", "--frames", pattern};
    };
    for (const char* pattern : {"%d.png", "walk-%04d.png", "a/b-%3d.jpg"})
        EXPECT_EQ(parsed(with(pattern)).frames, pattern);
    for (const char* pattern :
         {"walk.png", "%d-%d.png", "%s.png", "%n%d.png", "%0400d.png", "%ld.png", "100%%-%d.png", "%"})
        EXPECT_THAT(error_of(with(pattern)), HasSubstr("expected one number in the name")) << pattern;
    EXPECT_THAT(error_of(with("walk-%d.gif")), HasSubstr("unknown kind of picture"));
}

TEST(Options, HelpNamesEveryOptionKeyAndExitCodeWithin100Columns) {
    const std::string help = std::get<Answer>(parse_command_line({"--help"})).text;
    EXPECT_EQ(help, std::get<Answer>(parse_command_line({"-h"})).text);
    for (const LimitOption& option : limit_options)
        EXPECT_THAT(help, HasSubstr("\n  " + std::string(option.name) + " N")) << option.name;
    for (const char* option : {"--travel",
                               "--render OUT",
                               "--capture OUT",
                               "--check",
                               "--size WxH",
                               "--spp N",
                               "--projection NAME",
                               "--exposure VALUE",
                               "--seed N",
                               "--keys SCRIPT",
                               "--frames PATTERN",
                               "--stats FILE",
                               "-q,--quiet",
                               "-v,--verbose",
                               "-h,--help",
                               "--version",
                               "--threads N",
                               "--accelerator NAME",
                               "--isa NAME",
                               "--leaf-limit N",
                               "--depth-limit N",
                               "--traversal-cost KT",
                               "--intersection-cost KI",
                               "--allow-path DIR"})
        EXPECT_THAT(help, HasSubstr(std::string("\n  ") + option + " ")) << option;
    for (const char* text : {"-travel", "-render", "W S A D", "arrow keys", "examples:", "exit codes:", "130"})
        EXPECT_THAT(help, HasSubstr(text));
    EXPECT_THAT(help, Not(HasSubstr("\n\n\n")));
    EXPECT_THAT(help, Not(HasSubstr("Excludes")));
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST(Options, VersionIsOneLine) {
    EXPECT_EQ(std::get<Answer>(parse_command_line({"--version"})).text,
              std::string("raywalk ") + RAYWALK_VERSION + "\n");
}

}  // namespace
}  // namespace raywalk
