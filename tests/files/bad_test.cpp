// Of every file in tests/bad exactly the text beside it is told: it is refused, or, a mesh, read but for details.
// RAYWALK_RENEW=1 writes the texts anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/files/folder.h"
#include "tracer/files/mesh/obj_reader.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_files() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(RAYWALK_ROOT "/tests/bad"))
        if (entry.path().extension() == ".scene" || entry.path().extension() == ".obj")
            names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
}

bool is_mesh(const fs::path& file) { return file.extension() == ".obj"; }

// What reading the file says: warnings, then errors; without the place where this project lies.
std::string messages_of(const fs::path& file) {
    std::vector<Diagnostic> warnings;
    std::string text;
    try {
        if (is_mesh(file)) {
            text = "read, " + std::to_string(read_obj(file, {}, warnings).faces.size()) + " triangles";
        } else {
            read_scene(file, {}, warnings);
            text = "read";
        }
    } catch (const InputError& error) {
        text = error.what();
    }
    for (const Diagnostic& warning : warnings) text += "\n" + to_string(warning);
    const std::string root = fs::canonical(RAYWALK_ROOT);
    for (std::size_t at = text.find(root); at != std::string::npos; at = text.find(root))
        text.replace(at, root.size(), "ROOT");
    return text + "\n";
}

class BadFile : public testing::TestWithParam<std::string> {};

TEST_P(BadFile, IsToldOfInTheWordsBesideIt) {
    fs::current_path(RAYWALK_ROOT "/tests/bad");
    const std::string text = messages_of(GetParam());
    const bool refused = text.find(": error: ") != std::string::npos;
    EXPECT_TRUE(refused || (is_mesh(GetParam()) && text.find(": warning: ") != std::string::npos)) << text;
    const fs::path golden = GetParam() + ".txt";
    if (std::getenv("RAYWALK_RENEW")) std::ofstream(golden) << text;
    EXPECT_EQ(text, content_of(golden));
}

INSTANTIATE_TEST_SUITE_P(Description, BadFile, testing::ValuesIn(bad_files()), [](const auto& test) {
    std::string name = test.param;
    std::ranges::replace(name, '.', '_');
    return name;
});

}  // namespace
}  // namespace raywalk
