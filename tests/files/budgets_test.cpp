// What a scene may take together, and which files it may reach.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "tests/files/folder.h"
#include "tests/files/scene_text.h"
#include "tracer/files/load.h"
#include "tracer/files/scene_folders.h"
#include "tracer/ground/memory_left.h"

namespace raywalk {
namespace {

constexpr std::string_view triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string mesh_named(const std::string& file) {
    return "Mesh\ntexture PureTexture PLASTIC RED\nfile " + file + "\ncenter 0 0 0\nradius 1\n";
}
std::string ball_with(const std::string& image) {
    return "Sphere\ntexture ImageTexture PLASTIC " + image + "\ncenter 0 0 -5\nradius 1\n";
}
std::string start() { return std::string(viewer) + std::string(light); }

std::vector<Diagnostic> mesh_errors(const Scene& scene, const Limits& limits) {
    MemoryBudget memory(limits);
    return read_meshes(scene, limits, memory).errors;
}
std::vector<Diagnostic> image_errors(const Scene& scene, const Limits& limits) {
    MemoryBudget memory(limits);
    return read_images(scene, limits, memory).errors;
}

TEST(Budgets, MemoryOfAMeshThatIsNamedOftenCountsEachTime) {
    const TestFolder folder;
    folder.write("t.obj", triangle);
    std::string text = start();
    for (int i = 0; i < 10; ++i) text += mesh_named("t.obj");
    const Scene scene = parse(text, folder.path() / "x.scene");
    Limits limits;
    limits.memory_bytes = 10 * memory_of_a_triangle;
    EXPECT_TRUE(mesh_errors(scene, limits).empty());
    --limits.memory_bytes;
    const auto errors = mesh_errors(scene, limits);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].where, scene.meshes[9].where);
    EXPECT_TRUE(contains(errors[0].what, "with this mesh the scene needs")) << errors[0].what;
    EXPECT_TRUE(contains(errors[0].expected, "--max-memory"));
}

TEST(Budgets, SmallFilesMayAskForLessMemoryThanLargeOnes) {
    MemoryBudget small({}), large({});
    constexpr std::uint64_t gigabyte = 1 << 30;
    EXPECT_THROW(small.take(1000 * gigabyte, {}, "this mesh"), InputError);
    if (memory_left() < 6 * gigabyte) return;  // the machine's own limit comes first
    EXPECT_THROW(small.take(5 * gigabyte, {}, "this mesh"), InputError);
    large.allow_for_file(gigabyte);
    EXPECT_NO_THROW(large.take(5 * gigabyte, {}, "this mesh"));
}

TEST(Budgets, FilesAndErrorsAreCountedForEachKind) {
    const TestFolder folder;
    std::string text = start();
    for (int i = 0; i < 6; ++i) {
        folder.write(std::to_string(i) + ".obj", triangle);
        folder.write(std::to_string(i) + ".png", "x");
        text += mesh_named(std::to_string(i) + ".obj") + ball_with(std::to_string(i) + ".png");
    }
    const Scene scene = parse(text, folder.path() / "x.scene");
    Limits limits;
    limits.files = 6;
    EXPECT_TRUE(mesh_errors(scene, limits).empty());
    EXPECT_EQ(image_errors(scene, limits).size(), 6u);
    limits.errors = 2;
    EXPECT_LE(image_errors(scene, limits).size(), 2u);
    limits = {};
    limits.files = 5;
    ASSERT_EQ(mesh_errors(scene, limits).size(), 1u);
    EXPECT_TRUE(contains(mesh_errors(scene, limits)[0].expected, "--max-files"));
    const auto errors = image_errors(scene, limits);
    ASSERT_EQ(errors.size(), 6u);
    EXPECT_TRUE(contains(errors[5].expected, "--max-files")) << errors[5].what;
}

TEST(Budgets, TimeForAllFilesEnds) {
    const TestFolder folder;
    folder.write("t.obj", triangle);
    folder.write("t.png", "x");
    const Scene scene = parse(start() + mesh_named("t.obj") + ball_with("t.png"), folder.path() / "x.scene");
    Limits limits;
    limits.seconds = 0;  // over at once
    for (const auto& errors : {mesh_errors(scene, limits), image_errors(scene, limits)}) {
        ASSERT_EQ(errors.size(), 1u);
        EXPECT_TRUE(contains(errors[0].expected, "--max-seconds")) << errors[0].what;
    }
}

// Whether a scene in `folder` may name a file of the folder beside it.
bool reaches_beside(const fs::path& folder) {
    return SceneFolders(folder / "x.scene", {}).contain(folder.parent_path() / "beside/file");
}

TEST(SceneFolders, TheParentCountsWhereItLooksLikeAProject) {
    const TestFolder folder;
    for (const char* name :
         {"one/scenes", "two/scenes", "two/objs", "two/other", "three/scenes", "three/objs", "three/textures",
          "four/scene", "four/texture", "home/scenes", "home/objs", "shared/scenes", "shared/objs"})
        fs::create_directories(folder.path() / name);
    EXPECT_FALSE(reaches_beside(folder.path() / "one/scenes")) << "nothing beside it";
    EXPECT_TRUE(reaches_beside(folder.path() / "two/scenes"));
    EXPECT_TRUE(reaches_beside(folder.path() / "two/objs"));
    EXPECT_FALSE(reaches_beside(folder.path() / "two/other"));
    EXPECT_TRUE(reaches_beside(folder.path() / "three/scenes"));
    EXPECT_TRUE(reaches_beside(folder.path() / "four/scene")) << "as the report has them";
    ASSERT_EQ(chmod((folder.path() / "shared").c_str(), 01777), 0);
    EXPECT_FALSE(reaches_beside(folder.path() / "shared/scenes")) << "everybody may write there";
    const char* home = std::getenv("HOME");
    const std::string before = home == nullptr ? "" : home;
    setenv("HOME", (folder.path() / "home").c_str(), 1);
    EXPECT_FALSE(reaches_beside(folder.path() / "home/scenes"));
    setenv("HOME", before.c_str(), 1);
    EXPECT_TRUE(reaches_beside(folder.path() / "home/scenes"));
}

TEST(SceneFolders, AFolderJustBelowTheRootReachesNothingElse) {
    EXPECT_FALSE(SceneFolders("/scenes/x.scene", {}).contain("/etc/passwd"));
    EXPECT_FALSE(SceneFolders("/x.scene", {}).contain("/etc/passwd"));
    EXPECT_TRUE(SceneFolders("/no/such/folder/x.scene", {}).contain("/no/such/folder/below/a.obj"));
}

TEST(SceneFolders, ALinkThatComesAfterTheCheckIsNotFollowed) {
    const TestFolder folder, other;
    other.write("secret", "root:x:0:0\n");
    const fs::path file = folder.write("a.obj", triangle);
    const Scene scene = parse(start() + mesh_named("a.obj"), folder.path() / "x.scene");
    fs::remove(file);
    fs::create_symlink(other.path() / "secret", file);
    const auto errors = mesh_errors(scene, {});
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_TRUE(contains(to_string(errors[0]), "lies outside the folders")) << to_string(errors[0]);
    EXPECT_FALSE(contains(to_string(errors[0]), "root:x"));
}

TEST(SceneFolders, LinesOfFilesElsewhereAreNotShown) {
    const TestFolder folder;
    folder.write("objs/bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\nsecret line\n");
    folder.write("scenes/bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\n");
    const Scene scene =
        parse(start() + mesh_named("../objs/bad.obj") + mesh_named("bad.obj"), folder.path() / "scenes/x.scene");
    MemoryBudget memory({});
    const auto warnings = read_meshes(scene, {}, memory).warnings;
    std::size_t shown = 0, withheld = 0;
    for (const Diagnostic& warning : warnings) {
        const bool own = fs::path(warning.where.file).parent_path().filename() == "scenes";
        EXPECT_EQ(warning.quotable, own) << warning.where.file;
        EXPECT_EQ(warning.source_line.empty(), !own) << warning.source_line;
        ++(own ? shown : withheld);
    }
    EXPECT_GT(shown, 0u);
    EXPECT_GT(withheld, 0u);
}

}  // namespace
}  // namespace raywalk
