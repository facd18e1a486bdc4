// The program where something is wrong: its input, its surroundings, its user's patience.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include "tests/app/command_line_fixture.h"
#include "tracer/ground/sanitized.h"

namespace raywalk {
namespace {

// ---- what goes wrong

TEST_F(CommandLine, AWrongCommandLineEndsWithTwo) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{},
                                                  {"room.scene", "--exposre", "2"},
                                                  {"room.scene", "-render"},
                                                  {"room.scene", "-render", "a.gif"},
                                                  {"room.scene", "-render", "a.png", "--size", "big"},
                                                  {"room.scene", "-render", "a.png", "--keys", "w3x"}}) {
        const Outcome outcome = raywalk(words);
        EXPECT_EQ(outcome.exit_code, 2);
        EXPECT_EQ(outcome.output, "");
        EXPECT_NE(outcome.errors, "");
    }
    EXPECT_THAT(raywalk({"room.scene", "--exposre", "2"}).errors, HasSubstr("did you mean '--exposure'?"));
    EXPECT_THAT(raywalk({"room.scene", "--check", "--keys", "w3x"}).errors,
                HasSubstr("--keys:1:3: error: unknown key"));
    EXPECT_EQ(files(), 1u);
}

TEST_F(CommandLine, AWrongSceneEndsWithThreeBeforeAnythingIsWritten) {
    write_file(path("room.scene"), "Viewer\ngeo 64 48\ncente 0 0 0\n");
    const Outcome wrong = raywalk({"room.scene", "-render", "picture.png"});
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_THAT(wrong.errors, HasSubstr("room.scene:3:1: error:"));
    EXPECT_EQ(raywalk({"missing.scene", "-render", "picture.png"}).exit_code, 3);
    EXPECT_EQ(raywalk({".", "-render", "picture.png"}).exit_code, 3);
    EXPECT_EQ(files(), 1u);
}

TEST_F(CommandLine, AFolderThatCannotBeWrittenToEndsWithOneBeforeTheSceneIsRead) {
    const Outcome outcome = raywalk({"missing.scene", "-render", "no/picture.png"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("cannot write 'no/picture.png': its folder 'no' does not exist"));
    fs::create_directory(path("folder.png"));
    EXPECT_EQ(raywalk({"room.scene", "-render", "folder.png"}).exit_code, 1);
}

TEST_F(CommandLine, AFullOrClosedStandardOutputEndsWithOne) {
    Process full = process({"room.scene", "--check"});
    full.output_file = "/dev/full";
    const Outcome outcome = run(full);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("cannot write to standard output: No space left on device"));
    Process closed = process({"room.scene", "--check"});
    closed.closed_output = true;
    EXPECT_EQ(run(closed).exit_code, 1);
    Process rendered = process({"room.scene", "-render", "picture.png"});
    rendered.closed_output = true;  // not needed here
    EXPECT_EQ(run(rendered).exit_code, 0);
    EXPECT_EQ(pixels("picture.png").width, 64);
}

TEST_F(CommandLine, AFullDiskEndsWithOneAndKeepsNothing) {
    fs::create_symlink("/dev/full", path("full.png"));
    const Outcome outcome = raywalk({"room.scene", "-render", "full.png"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("cannot write 'full.png': No space left on device"));
}

TEST_F(CommandLine, AFileThatMayNotGrowEndsWithOneAndKeepsTheOldOne) {
    const std::string old = picture({}, "picture.pfm");
    Process limited = process({"room.scene", "-render", "picture.pfm", "--size", "300x300"});
    limited.file_size_limit = 65'536;
    const Outcome outcome = run(limited);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.signal;
    EXPECT_THAT(outcome.errors, HasSubstr("cannot write 'picture.pfm': File too large"));
    EXPECT_EQ(read_file(path("picture.pfm")), old);
    EXPECT_EQ(files(), 2u);
}

TEST_F(CommandLine, AnOutputNeverDestroysWhatTheSceneIsMadeOf) {
    write_file(path("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_image(path("floor0.png"), 2, 2, std::vector<std::uint8_t>(12, 128));
    fs::create_symlink("floor0.png", path("link.png"));
    write_file(path("room.scene"), std::string(small_scene) +
                                       "Mesh\ntexture PureTexture PLASTIC RED\nfile t.obj\ncenter 0 0 -9\nradius 1\n"
                                       "Plane\ntexture ImageTexture FLOOR floor0.png\nnormal 0 1 0\noffset -2\n");
    const auto contents = [&] {
        return read_file(path("room.scene")) + read_file(path("t.obj")) + read_file(path("floor0.png"));
    };
    const std::string before = contents();
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"-render", "floor0.png"},
          {"-render", "link.png"},
          {"-render", "../" + folder_.path().filename().string() + "/floor0.png"},
          {"-render", "a.png", "--stats", "room.scene"},
          {"-render", "a.png", "--stats", "t.obj"},
          {"-render", "a.png", "--stats", "a.png"}}) {
        std::vector<std::string> all = {"room.scene"};
        all.insert(all.end(), words.begin(), words.end());
        const Outcome outcome = raywalk(all);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
        EXPECT_THAT(outcome.errors, HasSubstr("choose another"));
        EXPECT_EQ(contents(), before);
    }
}

TEST_F(CommandLine, NoNameSteersTheTerminal) {
    const std::string name = "a\x1b[2J\xE2\x80\xAE\n.png";
    for (const std::vector<std::string>& words : {std::vector<std::string>{"room.scene", "-render", name},
                                                  {"room.scene", "-render", name + "/a.png"},
                                                  {name, "-render", "a.png"},
                                                  {"room.scene", "--check", "--" + name},
                                                  {"room.scene", "--check", "--keys", name}}) {
        const Outcome outcome = raywalk(words);
        EXPECT_THAT(outcome.errors, HasSubstr("a?[2J??.png"));
        for (const char c : outcome.output + outcome.errors) EXPECT_TRUE(c == '\n' || (c >= 0x20 && c < 0x7F));
    }
}

TEST_F(CommandLine, WhatIsNoFaultOfAnImageEndsWithOne) {
    write_image(path("floor.png"), 2, 2, std::vector<std::uint8_t>(12, 128));
    write_file(path("room.scene"),
               std::string(small_scene) + "Plane\ntexture ImageTexture FLOOR floor.png\nnormal 0 1 0\noffset -2\n");
    fs::copy_file(RAYWALK_PROGRAM, path("raywalk"));  // without the programs that read images
    Process alone = process({"room.scene", "--check"});
    alone.words[0] = path("raywalk").string();
    const Outcome outcome = run(alone);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("the program raywalk_png_jpeg is neither in"));
}

// Before the scene is read: there is none here.
TEST_F(CommandLine, AMissingEncoderIsNoticedBeforeTheWork) {
    fs::copy_file(RAYWALK_PROGRAM, path("raywalk"));  // without the programs that write images
    for (const std::string name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif"}) {
        Process alone = process({"none.scene", "-render", name});
        alone.words[0] = path("raywalk").string();
        const Outcome outcome = run(alone);
        EXPECT_EQ(outcome.exit_code, 1) << name;
        EXPECT_THAT(outcome.errors, HasSubstr("cannot write '" + name + "': the program raywalk_")) << name;
    }
    Process alone = process({"room.scene", "-render", "a.pfm", "--quiet"});
    alone.words[0] = path("raywalk").string();
    EXPECT_EQ(run(alone).exit_code, 0);
}

// Whether a message names a file of radiance, and that holds the small scene's picture.
bool rescued_picture(const std::string& message, const std::string& name, const fs::path& folder) {
    const std::string before = "its radiance is saved as '";
    const std::size_t at = message.find(before);
    if (at == std::string::npos) return false;
    const std::size_t begin = at + before.size();
    const fs::path file = message.substr(begin, message.find('\'', begin) - begin);
    if (file.filename().string().find("rescued-" + name) != 0) return false;
    return read_file(folder / file).starts_with("PF\n64 48\n");
}

TEST_F(CommandLine, AnEncoderThatBreaksEndsWithOneAndKeepsTheOldPicture) {
    fs::copy_file(RAYWALK_PROGRAM, path("raywalk"));
    const std::pair<const char*, const char*> ends[] = {
        {RAYWALK_CRASH, "Segmentation fault"}, {"/bin/false", "gave up"}, {"/bin/true", "said nothing"}};
    for (const auto& [end, message] : ends)
        for (const std::string name : {"a.png", "a.exr"}) {
            for (const char* program : {"raywalk_png_jpeg", "raywalk_openimageio"}) {
                fs::copy_file(end, path(program), fs::copy_options::overwrite_existing);
            }
            write_file(path(name), "old");
            Process broken = process({"room.scene", "-render", name, "--quiet"});
            broken.words[0] = path("raywalk").string();
            const Outcome outcome = run(broken);
            EXPECT_EQ(outcome.exit_code, 1) << name;
            EXPECT_THAT(outcome.errors, HasSubstr("cannot write '" + name + "': ")) << name;
            EXPECT_THAT(outcome.errors, HasSubstr(message)) << name;
            EXPECT_EQ(read_file(path(name)), "old");
            EXPECT_TRUE(rescued_picture(outcome.errors, name, path(""))) << outcome.errors;
        }
}

TEST_F(CommandLine, AnAbsurdNumberOfThreadsOfTheEnvironmentIsNone) {
    const std::string once = picture({}, "a.pfm");
    Process absurd = process({"room.scene", "-render", "a.pfm", "--quiet"});
    absurd.environment = {"OMP_NUM_THREADS=1000000"};
    EXPECT_EQ(run(absurd).exit_code, 0);
    EXPECT_EQ(read_file(path("a.pfm")), once);
}

TEST_F(CommandLine, SmallStacksAreMadeLargerOrRefused) {
    const std::string picture_of_large_stacks = picture({}, "a.pfm");
    Process small = process({"room.scene", "-render", "a.pfm", "--quiet", "--threads", "2"});
    for (const char* variable : {"OMP_STACKSIZE=16k", "OMP_STACKSIZE=16", "GOMP_STACKSIZE= 16384 B"}) {
        small.environment = {variable};
        EXPECT_EQ(run(small).exit_code, 0) << variable;
        EXPECT_EQ(read_file(path("a.pfm")), picture_of_large_stacks);
    }
    small.stack_limit = std::size_t{64} << 10;
    const Outcome refused = run(small);
    EXPECT_EQ(refused.exit_code, 1) << refused.signal;
    EXPECT_THAT(refused.errors, HasSubstr("the stack is limited to 64 KB, and 1024 KB are needed: ulimit -s 1024"));
}

TEST_F(CommandLine, TooLittleMemoryEndsWithOneAndAMessage) {
#if RAYWALK_SANITIZED  // whose own memory is past every limit: only that it still runs
    EXPECT_EQ(raywalk({"room.scene", "-render", "picture.png", "--size", "64x64"}).exit_code, 0);
#else
    Process process_with_little =
        process({"room.scene", "-render", "picture.png", "--size", "16384x16384", "--threads", "2"});
    process_with_little.memory_limit = std::size_t{1} << 30;
    const Outcome outcome = run(process_with_little);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("out of memory"));
    EXPECT_EQ(files(), 1u);
#endif
}

TEST_F(CommandLine, NamesInStatisticsSteerNoTerminal) {
    const std::string name =
        "a\xC2\x9B"
        "2Jb.scene";  // a C1 control character
    fs::copy_file(path("room.scene"), path(name));
    const Outcome outcome = raywalk({name, "-render", "a.png", "-q", "--stats", "-"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(outcome.output.find('\xC2'), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(outcome.output)["scene"]["file"], name);
}

TEST_F(CommandLine, NoLimitCanBeRaisedBeyondWhatNumbersHold) {
    const Outcome outcome = raywalk({"room.scene", "-render", "a.png", "--max-samples", "9007199254740992"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.errors, HasSubstr("--max-samples: expected a whole number from 1 to 16777216"));
}

// ---- interruptions

// Processor time that a process has used, seconds; negative when it is gone.
double processor_seconds(int id) {
    std::string status = read_file("/proc/" + std::to_string(id) + "/stat");
    if (status.empty()) return -1;
    std::istringstream fields(status.substr(status.rfind(')') + 2));
    std::string skipped;
    for (int field = 3; field < 14; ++field) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

// Starts a render that would take hours and calls `disturb` when it has worked for longer than reading its scene takes:
// by its own time, as a busy machine may not let it begin for seconds.
Outcome disturbed(Process process, const std::function<void(int)>& disturb) {
    std::thread disturber;
    process.started = [&](int id) {
        disturber = std::thread([&, id] {
            constexpr double reading_and_more = RAYWALK_SANITIZED ? 2 : 0.5;
            for (double used = 0; used >= 0 && used < reading_and_more; used = processor_seconds(id))
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            disturb(id);
        });
    };
    Outcome outcome = run(process);
    disturber.join();
    return outcome;
}

TEST_F(CommandLine, AnInterruptSavesWhatThereIsAndEndsWith130) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const Outcome outcome = disturbed(process({"room.scene", "-render", "picture.png", "--spp", "10000000"}),
                                          [&](int id) { kill(id, signal); });
        EXPECT_EQ(outcome.exit_code, 130);
        EXPECT_THAT(outcome.errors, HasSubstr("saving ..."));
        EXPECT_THAT(outcome.errors, HasSubstr("interrupted after"));
        EXPECT_THAT(outcome.errors, HasSubstr("'picture.png' holds"));
        const Image image = pixels("picture.png");
        EXPECT_EQ(image.width, 64);
        EXPECT_GT(largest_channel(image), 0);
        EXPECT_EQ(files(), 2u);
        fs::remove(path("picture.png"));
    }
}

TEST_F(CommandLine, AnInterruptSavesEveryFormatWhole) {
    for (const std::string name : {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif", "a.pfm"}) {
        const Outcome outcome =
            disturbed(process({"room.scene", "-render", name, "--spp", "10000000", "--size", "301x203"}),
                      [&](int id) { kill(id, SIGINT); });
        EXPECT_EQ(outcome.exit_code, 130) << name;
        if (name == "a.pfm") continue;  // which nobody reads here
        EXPECT_GT(largest_channel(pixels(name)), 0) << name;
    }
    EXPECT_EQ(fs::file_size(path("a.pfm")), std::string("PF\n301 203\n-1.0\n").size() + 301 * 203 * 12);
    EXPECT_EQ(files(), 7u);
}

// Its folder is gone when the work is done; then the folder of temporary files takes the radiance.
TEST_F(CommandLine, APictureWhoseFolderIsGoneIsRescued) {
    fs::create_directory(path("gone"));
    fs::create_directory(path("temporary"));
    Process endless = process({"room.scene", "-render", "gone/a.png", "--spp", "10000000"});
    endless.environment.push_back("TMPDIR=" + path("temporary").string());
    const Outcome outcome = disturbed(endless, [&](int id) {
        fs::remove_all(path("gone"));
        kill(id, SIGINT);
    });
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("cannot write 'gone/a.png'"));
    EXPECT_TRUE(rescued_picture(outcome.errors, "a.png", path(""))) << outcome.errors;
}

#if !RAYWALK_SANITIZED  // whose own memory is past every limit
// The encoder has no memory for its libraries, and this program none but what it set aside.
TEST_F(CommandLine, APictureIsRescuedFromALateLimitOfMemory) {
    for (const std::string name : {"a.exr", "a.tif", "a.hdr"}) {
        const Outcome outcome =
            disturbed(process({"room.scene", "-render", name, "--spp", "10000000", "--threads", "2"}), [&](int id) {
                const rlimit little{1 << 20, 1 << 20};
                prlimit(id, RLIMIT_AS, &little, nullptr);
                kill(id, SIGINT);
            });
        EXPECT_EQ(outcome.exit_code, 1) << outcome.signal << outcome.errors;
        EXPECT_TRUE(rescued_picture(outcome.errors, name, path(""))) << outcome.errors;
        EXPECT_FALSE(fs::exists(path(name)));
    }
}
#endif

TEST_F(CommandLine, ARepeatedInterruptIsOneAndThePictureIsSaved) {
    const Outcome outcome =
        disturbed(process({"room.scene", "-render", "picture.png", "--spp", "10000000"}), [](int id) {
            kill(id, SIGINT);
            kill(id, SIGTERM);  // another signal: two of one kind may become one
        });
    EXPECT_EQ(outcome.exit_code, 130);
    EXPECT_GT(largest_channel(pixels("picture.png")), 0);
    EXPECT_EQ(files(), 2u);
}

// The only tile of this scene is minutes of work: 65,536 points of light at each hit, 4,000 planes in the way of each.
TEST_F(CommandLine, AnInterruptInsideALongTileSavesThePicture) {
    std::string scene =
        "Viewer\ngeo 16 16\ncenter 0 2 8\ntarget 0 1 0\nup 0 1 0\nfovy 45\n"
        "Light\narea 256 3\norigin 3 6 4\ncolor WHITE\nintensity 1\n";
    for (int i = 0; i < 4000; ++i)
        scene += "Plane\ntexture PureTexture A_BIT_MIRROR RED\nnormal " + std::to_string(i % 7 - 3) + " 1 " +
                 std::to_string(i % 5 - 2) + "\noffset -" + std::to_string(i % 1000 + 1) + "\n";
    write_file(path("slow.scene"), scene);
    const Outcome outcome =
        disturbed(process({"slow.scene", "-render", "picture.png"}), [](int id) { kill(id, SIGINT); });
    EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("holds 0.0 % of the picture's samples"));
    EXPECT_EQ(pixels("picture.png").width, 16);
}

TEST_F(CommandLine, AKillAtAnyMomentLeavesTheOldFileOrAWholeNewOne) {
    const std::string old = picture({"--size", "64x48"});
    const std::string new_picture = picture({"--size", "300x200"});
    for (int i = 0; i < 25; ++i) {
        write_file(path("picture.png"), old);
        Process killed = process({"room.scene", "-render", "picture.png", "--size", "300x200", "--quiet"});
        std::thread killer;
        killed.started = [&](int id) {
            killer = std::thread([id, i] {
                std::this_thread::sleep_for(std::chrono::milliseconds(4 * i));
                kill(id, SIGKILL);
            });
        };
        const Outcome outcome = run(killed);
        killer.join();
        const std::string left = read_file(path("picture.png"));
        EXPECT_TRUE(left == old || left == new_picture) << "killed after " << 4 * i << " ms";
        EXPECT_TRUE(outcome.exit_code != 0 || left == new_picture);
    }
    const std::vector<fs::path> parts = test::parts_in(folder_.path());
    for (const fs::path& part : parts) EXPECT_EQ(read_file(part), new_picture) << part;
    EXPECT_EQ(files(), 2 + parts.size()) << "something else was left behind";
}

}  // namespace
}  // namespace raywalk
