// The program as its users run it: what it prints, writes and returns.
#include <cstring>

#include "tests/app/command_line_fixture.h"
#include "tracer/ground/sanitized.h"

namespace raywalk {
namespace {

// Of a PFM file: linear RGB, rows from the bottom, as the format has it.
std::vector<float> pfm_values(const std::string& bytes) {
    std::size_t start = 0;
    for (int line = 0; line < 3; ++line) start = bytes.find('\n', start) + 1;
    std::vector<float> values((bytes.size() - start) / sizeof(float));
    std::memcpy(values.data(), bytes.data() + start, values.size() * sizeof(float));
    return values;
}
// ---- pictures

TEST_F(CommandLine, RendersAPictureAndSaysHowLongItTook) {
    const Outcome outcome = raywalk({"room.scene", "-render", "picture.png"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(outcome.errors,
                testing::ContainsRegex("rendered picture.png, 64 x 48 pixels, 1 sample each, in [0-9.]+ m?s"));
    EXPECT_EQ(pixels("picture.png").width, 64);
    EXPECT_EQ(pixels("picture.png").height, 48);
    EXPECT_EQ(files(), 2u);
}

TEST_F(CommandLine, RendersWithoutADisplayAndWithoutVulkan) {
    Process headless = process({"room.scene", "-render", "picture.png"});
    headless.environment.insert(headless.environment.end(),
                                {"DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "VK_DRIVER_FILES=/nonexistent",
                                 "VK_ICD_FILENAMES=/nonexistent"});
    EXPECT_EQ(run(headless).exit_code, 0);
}

TEST_F(CommandLine, WritesEveryFormat) {
    for (const char* name : {"a.png", "a.jpg", "a.jpeg", "a.exr", "a.pfm", "a.hdr", "a.tif", "a.tiff"})
        EXPECT_FALSE(picture({}, name).empty()) << name;
    EXPECT_EQ(read_file(path("a.png")).substr(1, 3), "PNG");
    EXPECT_EQ(read_file(path("a.jpg")).substr(0, 2), "\xFF\xD8");
    EXPECT_EQ(read_file(path("a.pfm")).substr(0, 2), "PF");
    EXPECT_EQ(read_file(path("a.exr")).substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(CommandLine, FloatFormatsHoldRadianceAnd8BitFormatsItsDisplayValues) {
    const std::vector<float> radiance = pfm_values(picture({}, "a.pfm"));
    ASSERT_EQ(radiance.size(), 64u * 48 * 3);
    const float largest = *std::max_element(radiance.begin(), radiance.end());
    ASSERT_GT(largest, 0.1f);
    picture({}, "normalized.png");
    picture({"--exposure", "0.5"}, "darker.png");
    const Image normalized = pixels("normalized.png"), darker = pixels("darker.png");
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const std::size_t pixel = std::size_t{64} * y + x;
            const float value = radiance[static_cast<std::size_t>((47 - y) * 64 + x) * 3];
            ASSERT_NEAR(red(normalized.texels[pixel]), 255 * value / std::max(1.0f, largest), 0.51);
            ASSERT_NEAR(red(darker.texels[pixel]), 255 * std::min(1.0f, value / 2), 0.51);
        }
}

TEST_F(CommandLine, NormalizingOnlyDarkens) {
    write_file(path("room.scene"), std::string(small_scene) + "Light\norigin 0 1 0\ncolor WHITE\nintensity 9\n");
    picture({"--exposure", "normalize"});
    EXPECT_EQ(largest_channel(pixels("picture.png")), 255);
    const Image bright = pixels("picture.png");
    picture({"--exposure", "1"});
    EXPECT_NE(pixels("picture.png").texels, bright.texels);
    const Outcome outcome = raywalk({"room.scene", "-render", "a.exr", "--exposure", "2"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.errors, HasSubstr("--exposure changes nothing here: .exr files hold linear radiance"));
}

TEST_F(CommandLine, SizeAndSamplesOverrideTheScene) {
    EXPECT_EQ(statistics({})["picture"]["samples_per_pixel"], 1);
    const auto picture_of = [&](std::vector<std::string> words) { return statistics(std::move(words))["picture"]; };
    EXPECT_EQ(picture_of({"--size", "33x17", "--spp", "3"})["width"], 33);
    EXPECT_EQ(pixels("picture.png").height, 17);
    EXPECT_EQ(picture_of({"--spp", "3"})["samples_per_pixel"], 3);
    std::string scene = small_scene;
    scene.insert(scene.find("fovy"), "dop 0.1 8 2\nanti 3\n");
    write_file(path("room.scene"), scene);
    EXPECT_EQ(picture_of({})["samples_per_pixel"], 6);
    EXPECT_EQ(picture_of({"--spp", "2"})["samples_per_pixel"], 2);
}

TEST_F(CommandLine, ProjectionOverridesTheScene) {
    const std::string perspective = picture({});
    const std::string orthographic = picture({"--projection", "orthographic"});
    EXPECT_NE(perspective, orthographic);
    EXPECT_EQ(picture({"--projection", "perspective"}), perspective);
    EXPECT_EQ(picture({"--keys", "t"}), orthographic);
}

TEST_F(CommandLine, KeysAreWalkedFirst) {
    const std::string still = picture({});
    EXPECT_NE(picture({"--keys", "2w3R"}), still);
    EXPECT_EQ(picture({"--keys", "tt"}), still);
    EXPECT_EQ(picture({"--keys", "q 5w"}), still);
    EXPECT_EQ(picture({"--keys", ""}), still);
    EXPECT_EQ(picture({"--keys", "2w3R"}), picture({"--keys", "w w R R R"}));
}

TEST_F(CommandLine, KeysOfTheExposureScaleIt) {
    const std::string still = picture({}), radiance = picture({}, "a.pfm");
    EXPECT_NE(picture({"--keys", "3["}), still);
    EXPECT_EQ(picture({"--keys", "3[ 3]"}), still);
    EXPECT_EQ(picture({"--keys", "q 3["}), still);
    EXPECT_EQ(picture({"--keys", "3]", "--exposure", "0.5"}), picture({"--exposure", "0.9765625"}));
    EXPECT_EQ(picture({"--keys", "2[", "--exposure", "1.25"}), picture({"--exposure", "0.8"}));
    EXPECT_EQ(picture({"--keys", "3] w", "--size", "32x24"}), picture({"--keys", "w 3]", "--size", "32x24"}));
    EXPECT_EQ(picture({"--keys", "3]"}, "a.pfm"), radiance) << "radiance has no exposure";
}

TEST_F(CommandLine, ThreadsAndRepetitionDoNotChangeThePicture) {
    const std::string once = picture({"--spp", "5"}, "a.pfm");
    for (const char* threads : {"1", "2", "7", "16"})
        EXPECT_EQ(picture({"--spp", "5", "--threads", threads}, "a.pfm"), once) << threads;
}

TEST_F(CommandLine, AcceleratorsAndTheirOptionsDoNotChangeThePicture) {
    const std::string tree = picture({"--accelerator", "kdtree"}, "a.pfm");
    EXPECT_EQ(picture({"--accelerator", "bvh"}, "a.pfm"), tree);
    EXPECT_EQ(
        picture({"--leaf-limit", "1", "--depth-limit", "30", "--traversal-cost", "0.75", "--intersection-cost", "3"},
                "a.pfm"),
        tree);
}

TEST_F(CommandLine, SeedsChangeTheSamples) {
    const std::string zero = picture({"--spp", "3"}, "a.pfm");
    EXPECT_EQ(picture({"--spp", "3", "--seed", "0"}, "a.pfm"), zero);
    EXPECT_NE(picture({"--spp", "3", "--seed", "1"}, "a.pfm"), zero);
}

// ---- progress and messages

TEST_F(CommandLine, ProgressIsALinePerTenPercentWhereThereIsNoTerminal) {
    const std::string errors = raywalk({"room.scene", "-render", "picture.png"}).errors;
    EXPECT_THAT(errors, Not(HasSubstr("\r")));
    EXPECT_THAT(errors, Not(HasSubstr("\x1b")));
    std::size_t place = 0;
    for (int percent = 10; percent <= 100; percent += 10) {
        const std::size_t next = errors.find(std::to_string(percent) + " %", place);
        ASSERT_NE(next, std::string::npos) << percent << "\n" << errors;
        place = next + 1;
    }
}

TEST_F(CommandLine, ProgressIsABarOnATerminalAndWipedOffInTheEnd) {
    const char* samples = RAYWALK_SANITIZED ? "60" : "3000";  // long enough for a bar
    Process terminal = process({"room.scene", "-render", "picture.png", "--spp", samples});
    terminal.terminal_columns = 60;
    terminal.environment.insert(terminal.environment.end(), {"TERM=xterm", "NO_COLOR"});
    const std::string errors = run(terminal).errors;
    EXPECT_THAT(errors, testing::ContainsRegex("\r\\[#*-+\\] +[0-9]+ %, [0-9a-z. ]+ left\x1b\\[K"));
    const std::size_t wiped = errors.rfind("\r\x1b[K");
    ASSERT_NE(wiped, std::string::npos);
    EXPECT_THAT(errors.substr(wiped), HasSubstr("rendered picture.png"));
    EXPECT_EQ(errors.find('[', wiped + 4), std::string::npos) << "a bar after the end";
}

TEST_F(CommandLine, ADumbTerminalGetsPlainLines) {
    Process terminal = process({"room.scene", "-render", "picture.png"});
    terminal.terminal_columns = 60;
    terminal.environment.emplace_back("TERM=dumb");
    const std::string errors = run(terminal).errors;
    EXPECT_THAT(errors, HasSubstr("100 %"));
    EXPECT_THAT(errors, Not(HasSubstr("\x1b")));
}

TEST_F(CommandLine, ColoursAreForTerminalsOnlyAndNoColorTurnsThemOff) {
    Process wrong = process({"room.scene", "--bogus"});
    wrong.terminal_columns = 60;
    wrong.environment.insert(wrong.environment.end(), {"TERM=xterm", "NO_COLOR"});
    EXPECT_THAT(run(wrong).errors, HasSubstr("\x1b[1;31merror:"));
    wrong.environment.back() = "NO_COLOR=1";
    EXPECT_THAT(run(wrong).errors, HasSubstr("raywalk: error:"));
    EXPECT_THAT(raywalk({"room.scene", "--bogus"}).errors, HasSubstr("raywalk: error:"));
}

TEST_F(CommandLine, QuietSaysNothing) {
    const Outcome outcome = raywalk({"room.scene", "-render", "picture.png", "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.output + outcome.errors, "");
}

TEST_F(CommandLine, VerboseTellsTimesAndThreads) {
    const std::string errors = raywalk({"room.scene", "-render", "picture.png", "--verbose", "--threads", "2"}).errors;
    for (const char* text : {"scene read in", "tree built in", "rays a second", "2 threads"})
        EXPECT_THAT(errors, HasSubstr(text));
}

TEST_F(CommandLine, HelpAndVersionGoToStandardOutput) {
    EXPECT_EQ(raywalk({"--version"}).output, std::string("raywalk ") + RAYWALK_VERSION + "\n");
    const Outcome help = raywalk({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.errors, "");
    EXPECT_THAT(help.output, HasSubstr("usage:"));
}

// ---- statistics and check

TEST_F(CommandLine, StatisticsHoldWhatIsPromised) {
    const nlohmann::json all = statistics({"--spp", "2", "--threads", "2", "--accelerator", "kdtree"});
    EXPECT_EQ(all["scene"]["triangles"], 1);
    EXPECT_EQ(all["scene"]["spheres"], 1);
    EXPECT_EQ(all["scene"]["planes"], 1);
    EXPECT_EQ(all["scene"]["lights"], 2);
    EXPECT_EQ(all["scene"]["light_points"], 10);
    EXPECT_EQ(all["rays"]["camera"], 64 * 48 * 2);
    EXPECT_GT(all["rays"]["shadow"], 0);
    EXPECT_GT(all["rays"]["reflection"], 0);
    EXPECT_EQ(all["rays"]["refraction"], 0);
    EXPECT_EQ(all["rays"]["dropped_samples"], 0);
    EXPECT_GT(all["rays"]["per_second"], 0);
    for (const char* name : {"read_scene", "read_meshes", "read_images", "build", "load", "trace"})
        EXPECT_GE(all["seconds"][name], 0) << name;
    EXPECT_EQ(all["tree"]["accelerator"], "kdtree");
    for (const char* name :
         {"inner_nodes", "leaves", "empty_leaves", "references", "depth", "sah_cost", "events", "bytes"})
        EXPECT_TRUE(all["tree"].contains(name)) << name;
    EXPECT_EQ(all["threads"], 2);
    EXPECT_TRUE(all["isa"].is_string());
}

TEST_F(CommandLine, StatisticsGoToAFileToo) {
    EXPECT_EQ(raywalk({"room.scene", "-render", "picture.png", "--stats", "stats.json"}).exit_code, 0);
    EXPECT_EQ(nlohmann::json::parse(read_file(path("stats.json")))["picture"]["width"], 64);
    const Outcome nowhere = raywalk({"room.scene", "-render", "picture.png", "--stats", "no/stats.json"});
    EXPECT_EQ(nowhere.exit_code, 1);
    EXPECT_THAT(nowhere.errors, HasSubstr("cannot write 'no/stats.json': its folder 'no' does not exist"));
}

TEST_F(CommandLine, CheckSaysWhatTheSceneHoldsAndRendersNothing) {
    write_file(path("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(path("room.scene"), std::string(small_scene) +
                                       "Mesh\ntexture PureTexture PLASTIC RED\nfile t.obj\n"
                                       "center 0 0 -9\nradius 1\nsmooth true\n");
    const Outcome outcome = raywalk({"room.scene", "--check"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
    for (const char* text : {"64 x 48 pixels, 1 sample each, perspective", "1 plane, 1 sphere, 1 face, 1 mesh",
                             "2 lights, 10 points", "t.obj, 1 triangle, 3 vertices, smooth"})
        EXPECT_THAT(outcome.output, HasSubstr(text));
    EXPECT_EQ(files(), 2u);
    EXPECT_EQ(raywalk({"room.scene", "--check", "--quiet"}).output, "");
}

TEST_F(CommandLine, CheckReportsEveryMistakeOfSceneMeshAndImage) {
    write_file(path("bad.obj"), "v 0 0\n");
    write_file(path("noise.png"), "noise");
    write_file(path("room.scene"), std::string(small_scene) +
                                       "Mesh\ntexture PureTexture PLASTIC RED\nfile bad.obj\ncenter 0 0 -9\nradius 1\n"
                                       "Sphere\ntexture ImageTexture FLOOR noise.png\ncenter 0 0 0\nradius 1\n");
    const Outcome outcome = raywalk({"room.scene", "--check"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.errors, HasSubstr("bad.obj:1:"));
    EXPECT_THAT(outcome.errors, HasSubstr("noise.png"));
    EXPECT_THAT(outcome.errors, HasSubstr("texture ImageTexture FLOOR noise.png\n"));  // the line of the scene
    EXPECT_THAT(outcome.errors, HasSubstr("^"));
}

// A lamp close to a wall makes a spot that a small picture sees the brightest point of less often than a large one.
TEST_F(CommandLine, APreviewIsAsBrightAsThePicture) {
    write_file(path("spot.scene"),
               "Viewer\ngeo 160 120\ncenter 0 1 6\ntarget 0 0.8 0\nup 0 1 0\nfovy 45\n"
               "Light\norigin 3 6 4\ncolor WHITE\nintensity 1\nLight\norigin 3 1 -5.9\ncolor WHITE\nintensity 4\n"
               "Plane\ntexture PureTexture FLOOR WHITE\nnormal 0 0 1\noffset -6\n");
    const auto brightness = [&](const std::string& size) {
        const Outcome outcome = raywalk({"spot.scene", "-render", "a.png", "-q", "--size", size});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        const Image image = pixels("a.png");
        double sum = 0;
        for (const std::uint32_t texel : image.texels) sum += red(texel);
        return sum / static_cast<double>(image.texels.size());
    };
    const double own = brightness("160x120");
    for (const char* size : {"40x30", "80x60", "640x480"}) EXPECT_NEAR(brightness(size) / own, 1, 0.01) << size;
}

TEST_F(CommandLine, OutputsOfOneRunAreDifferentFiles) {
    const std::vector<std::string> frames = {"room.scene", "--capture", "a-3.png", "--keys", "w", "--frames"};
    fs::create_directory(path("folder"));
    fs::create_symlink("../c-7.png", path("folder/link.json"));
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> words = frames;
        words.insert(words.end(), more.begin(), more.end());
        return raywalk(words);
    };
    for (const std::vector<std::string>& more : {std::vector<std::string>{"a-%d.png"},
                                                 {"./a-%02d.png"},
                                                 {"folder/../a-%d.png"},
                                                 {"b-%d.png", "--stats", "./a-3.png"},
                                                 {"c-%d.png", "--stats", "folder/link.json"}}) {
        const Outcome outcome = with(more);
        EXPECT_EQ(outcome.exit_code, 2) << more[0] << outcome.errors;
        EXPECT_THAT(outcome.errors, HasSubstr("choose another"));
    }
    EXPECT_EQ(files(), 2u) << "nothing was written";
}

TEST_F(CommandLine, ASceneThatShipsIsFoundByItsName) {
    for (const std::string name : {"cornell_box", "cornell_box.scene"}) {
        const Outcome outcome = raywalk({name, "-render", "box.png", "--size", "16x12", "--spp", "1"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
        EXPECT_EQ(pixels("box.png").width, 16);
    }
    write_file(path("cornell_box"), small_scene);  // what lies here comes first
    EXPECT_THAT(raywalk({"cornell_box", "--check"}).output, HasSubstr("1 plane, 1 sphere, 1 face"));
    EXPECT_EQ(raywalk({"./cornell_room", "--check"}).exit_code, 3);
    EXPECT_EQ(raywalk({"no_such_scene", "--check"}).exit_code, 3);
}

TEST_F(CommandLine, ASceneThatIsAMeshIsToldWhatToDo) {
    write_file(path("my chair.OBJ"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Outcome outcome = raywalk({"my chair.OBJ", "-render", "a.png"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.errors, HasSubstr("my chair.OBJ: error: a mesh is no scene"));
    EXPECT_THAT(outcome.errors, HasSubstr("`file \"my chair.OBJ\"`"));
    EXPECT_EQ(files(), 2u);
}

}  // namespace
}  // namespace raywalk
