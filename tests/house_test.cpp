// The house keeps its own rules: floors, names, sizes, text.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = RAYWALK_ROOT;

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const fs::path& file) {
    std::vector<std::string> lines;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

// Files below the named folders of the project whose extension is among the given ones, sorted.
std::vector<fs::path> files(const std::vector<std::string>& folders, const std::set<std::string>& extensions) {
    std::vector<fs::path> result;
    for (const std::string& folder : folders)
        for (const auto& entry : fs::recursive_directory_iterator(root / folder))
            if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
                result.push_back(entry.path());
    std::sort(result.begin(), result.end());
    return result;
}

// Inputs of tests that are wrong on purpose.
bool is_meant_to_be_odd(const fs::path& file) {
    const std::string name = file.lexically_relative(root).generic_string();
    return name.starts_with("tests/bad/") || name.find("corpus/") != std::string::npos;
}

std::vector<fs::path> sources() { return files({"tracer", "app", "scenes", "tests"}, {".h", ".cpp"}); }

std::string name_of(const fs::path& file) { return file.lexically_relative(root).generic_string(); }

// Floors from the ground up; a folder that is none of them has no place in an include of tracer or app.
constexpr std::array floors = {"tracer/ground/",   "tracer/scene/",   "tracer/files/",     "tracer/picture/",
                               "tracer/compiled/", "tracer/kernels/", "tracer/rendering/", "app/"};

std::optional<std::size_t> floor_of(const std::string& path) {
    for (std::size_t i = 0; i < floors.size(); ++i)
        if (path.starts_with(floors[i])) return i;
    return {};
}

TEST(House, FilesIncludeOnlyTheirOwnFloorOrLowerOnes) {
    const std::regex include(R"(^\s*#\s*include\s+"([^"]+)\")");
    for (const fs::path& file : files({"tracer", "app"}, {".h", ".cpp"})) {
        const auto own = floor_of(name_of(file));
        ASSERT_TRUE(own) << name_of(file) << " stands on no floor";
        for (const std::string& line : lines_of(file)) {
            std::smatch match;
            if (!std::regex_search(line, match, include)) continue;
            const std::string included = match[1];
            const auto theirs = floor_of(included);
            if (!theirs) {
                EXPECT_FALSE(fs::exists(root / included))
                    << name_of(file) << " includes " << included << ", which is on no floor";
                continue;
            }
            EXPECT_TRUE(*theirs <= *own) << name_of(file) << " includes " << included << " of a higher floor";
        }
    }
}

TEST(House, TheLibraryKnowsNoWindowNoVulkanAndNoCommandLine) {
    const std::regex foreign(R"(#\s*include\s*[<"](vulkan|GLFW|imgui|CLI)/)");
    for (const fs::path& file : files({"tracer"}, {".h", ".cpp"}))
        EXPECT_FALSE(std::regex_search(text_of(file), foreign)) << name_of(file);
}

TEST(House, AFileIsOneIdeaOfSomeFourHundredLinesAtMost) {
    for (const fs::path& file : sources()) {
        const std::size_t most = name_of(file).starts_with("tests/") ? 500 : 420;
        EXPECT_LE(lines_of(file).size(), most) << name_of(file);
    }
}

// Where RAYWALK_UNITY compiles them together, a call could find the other's function.
TEST(House, SourcesOfATargetGiveTheirFunctionsDifferentNames) {
    const std::regex target(R"((?:add_library|raywalk_tests)\([^)]*\))"), source(R"([a-z0-9_/]+\.cpp)"),
        function(R"(^[A-Za-z][^=(]*[ &*]([a-z0-9_]+)\()");
    for (const fs::path folder : {"tracer", "app", "tests", "tests/window"}) {
        const std::string text = text_of(root / folder / "CMakeLists.txt");
        for (std::sregex_iterator found(text.begin(), text.end(), target), end; found != end; ++found) {
            const std::string list = found->str();
            std::map<std::string, std::string> source_of;
            for (std::sregex_iterator word(list.begin(), list.end(), source); word != end; ++word)
                for (const std::string& line : lines_of(root / folder / word->str())) {
                    std::smatch match;
                    if (!std::regex_search(line, match, function)) continue;
                    const std::string& first = source_of.try_emplace(match[1], word->str()).first->second;
                    EXPECT_EQ(first, word->str()) << "both give a function the name " << match[1];
                }
        }
    }
}

TEST(House, NamesAreLowerCaseWordsJoinedByUnderscores) {
    const std::regex name("[a-z0-9]+(_[a-z0-9]+)*\\.(h|cpp)");
    for (const fs::path& file : sources())
        EXPECT_TRUE(std::regex_match(file.filename().string(), name)) << name_of(file);
}

TEST(House, EveryFileBeginsBySayingWhatItIs) {
    for (const fs::path& file : files({"tracer", "app", "scenes"}, {".h"})) {
        const auto lines = lines_of(file);
        ASSERT_FALSE(lines.empty()) << name_of(file);
        EXPECT_TRUE(lines[0].starts_with("// ")) << name_of(file);
        // Headers of kernels are read once per instruction set.
        const std::string text = text_of(file);
        EXPECT_TRUE(text.find("\n#pragma once\n") != text.npos || text.find("HWY_TARGET_TOGGLE") != text.npos)
            << name_of(file) << " does not guard itself";
    }
}

TEST(House, TextIsCleanAndPromisesNothingForLater) {
    const std::regex later(
        "\\b(TO"
        "DO|FIX"
        "ME|X"
        "XX)\\b");
    auto texts = sources();
    const auto more = files({"app", "scenes", "tests", ".ci"}, {".txt", ".sh", ".md", ".scene", ".comp", ".glsl"});
    texts.insert(texts.end(), more.begin(), more.end());
    for (const fs::path& file : texts) {
        if (is_meant_to_be_odd(file)) continue;
        const std::string text = text_of(file);
        EXPECT_TRUE(text.empty() || text.back() == '\n') << name_of(file) << " does not end its last line";
        std::size_t number = 0;
        for (const std::string& line : lines_of(file)) {
            ++number;
            EXPECT_FALSE(line.ends_with(' ') || line.ends_with('\r') || line.ends_with('\t'))
                << name_of(file) << ':' << number;
            EXPECT_FALSE(std::regex_search(line, later)) << name_of(file) << ':' << number << ": " << line;
        }
    }
}

TEST(House, NoFileNamesAPlaceOfOneMachine) {
    const std::regex place(R"(["' (=](/ho)"
                           "me/|/ro"
                           "ot/|/us"
                           "ers/|/wo"
                           "rk/)",
                           std::regex::icase);
    auto texts = sources();
    const auto more = files({"app", "scenes", "tests", ".ci", "tracer"}, {".sh", ".md", ".scene", ".txt"});
    for (const fs::path& file : more)
        if (name_of(file).find("build/") == std::string::npos) texts.push_back(file);
    for (const fs::path& file : texts) EXPECT_FALSE(std::regex_search(text_of(file), place)) << name_of(file);
}

TEST(House, EverySourceIsBuilt) {
    for (const fs::path& file : files({"tracer", "app", "scenes", "tests"}, {".cpp"})) {
        bool listed = false;
        for (fs::path folder = file.parent_path(); !listed && folder != root.parent_path();
             folder = folder.parent_path()) {
            const std::string list = text_of(folder / "CMakeLists.txt");
            const std::string name = file.lexically_relative(folder).generic_string();
            // A function there that makes fuzz_NAME of fuzz_NAME.cpp.
            const std::string call =
                "raywalk_fuzzer(" + (name.starts_with("fuzz_") ? file.stem().string().substr(5) : "-");
            listed = list.find(name) != std::string::npos || list.find(call) != std::string::npos;
        }
        EXPECT_TRUE(listed) << name_of(file) << " is in no CMakeLists.txt";
    }
}

TEST(House, EveryTestThatIsPromisedExists) {
    std::string tests;
    for (const fs::path& file : files({"tests"}, {".cpp"})) tests += text_of(file);
    const std::string promises = text_of(root / "tests/README.md");
    const std::regex name("`([A-Z][A-Za-z0-9]*)\\.([A-Z][A-Za-z0-9]*)`");
    std::size_t named = 0;
    for (std::sregex_iterator match(promises.begin(), promises.end(), name), end; match != end; ++match, ++named)
        EXPECT_NE(tests.find((*match)[1].str() + ", " + (*match)[2].str()), std::string::npos) << match->str();
    EXPECT_GT(named, 50u);
    const std::regex script("`window\\.([a-z_]+)`");
    for (std::sregex_iterator match(promises.begin(), promises.end(), script), end; match != end; ++match)
        EXPECT_TRUE(fs::exists(root / "tests/window" / ((*match)[1].str() + ".sh"))) << match->str();
}

}  // namespace
