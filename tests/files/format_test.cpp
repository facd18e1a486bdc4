// scenes/FORMAT.md and the parser agree: every example is read, and every word that the parser knows is in an example.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

#include "tests/files/folder.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk {
namespace {

// The fenced examples of the document.
std::vector<std::string> examples() {
    std::vector<std::string> found;
    std::istringstream lines(content_of(RAYWALK_ROOT "/scenes/FORMAT.md"));
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) {
            inside = line == "```scene";
            if (inside) found.emplace_back();
        } else if (inside) {
            found.back() += line + "\n";
        }
    }
    return found;
}

// Where the examples' files are.
class ScenesFolder {
  public:
    ScenesFolder() {
        for (const char* file : {"objs/teapot.obj", "objs/my mesh.obj", "textures/brick.png",
                                 "textures/a name with blanks.jpg", "scenes/x.scene"})
            folder_.write(file, "");
    }
    [[nodiscard]] std::filesystem::path scene() const { return folder_.path() / "scenes/x.scene"; }

  private:
    TestFolder folder_;
};

std::string said_beside(const std::string& text, const std::filesystem::path& file) {
    std::vector<Diagnostic> warnings;
    try {
        parse_scene(text, file, {}, warnings);
        return "read";
    } catch (const InputError& error) {
        return error.what();
    }
}

constexpr const char* viewer = "Viewer\ngeo 64 48\ncenter 0 0 0\ntarget 0 0 -1\nup 0 1 0\nfovy 45\n";

TEST(FormatTest, EveryExampleIsRead) {
    const ScenesFolder folder;
    ASSERT_GE(examples().size(), 8u);
    for (const std::string& example : examples()) {
        const bool whole = example.find("Viewer\n") != std::string::npos;
        EXPECT_EQ(said_beside((whole ? "" : viewer) + example, folder.scene()), "read") << example;
    }
}

// The words that an error offers: "expected one of A, B, C".
std::vector<std::string> offered(const std::string& text) {
    const std::string text_before = "expected one of ";
    const std::string said = said_beside(text, "x.scene");
    const std::size_t begin = said.find(text_before);
    EXPECT_NE(begin, std::string::npos) << said;
    if (begin == std::string::npos) return {};
    std::string list = said.substr(begin + text_before.size());
    list.resize(std::min(list.find('\n'), list.size()));
    std::erase(list, ',');
    std::istringstream words(list);
    std::vector<std::string> result;
    for (std::string word; words >> word;) result.push_back(word);
    return result;
}

TEST(FormatTest, EveryWordOfTheParserIsInAnExample) {
    std::set<std::string> shown;
    for (const std::string& example : examples()) {
        std::istringstream words(example);
        for (std::string word; words >> word;) shown.insert(word);
    }
    const std::vector<std::string> blocks = offered("Xxxxxxxx\n");
    std::vector<std::string> known = blocks;
    for (const std::string& block : blocks)
        for (const std::string& property : offered(block + "\nxxxxxxxx 1\n")) known.push_back(property);
    for (const char* wrong : {"Light\ncolor 1\n", "Sphere\ntexture 1\n", "Sphere\ntexture PureTexture 1\n",
                              "Sphere\nrefraction_index 1\n", "Mesh\nsmooth 1\n"})
        for (const std::string& word : offered(viewer + std::string(wrong))) known.push_back(word);
    EXPECT_GT(known.size(), 45u);
    for (const std::string& word : known)
        EXPECT_TRUE(shown.contains(word) || word == "True" || word == "false") << word;  // spellings of those shown
}

}  // namespace
}  // namespace raywalk
