// Which files a scene may be and may name.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/files/folder.h"
#include "tests/files/scene_text.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk {
namespace {

std::string mesh_of(std::string_view file) {
    return std::string(viewer) + std::string(light) + "Mesh\ntexture PureTexture PLASTIC RED\nfile " +
           std::string(file) + "\ncenter 0 0 0\nradius 1\n";
}

TEST(SceneTest, FilesBesideTheSceneAndBesideItsFolderMayBeNamed) {
    const TestFolder folder;
    folder.write("scenes/a.obj", "");
    folder.write("objs/b.obj", "");
    const fs::path scene = folder.path() / "scenes/x.scene";
    EXPECT_EQ(parse(mesh_of("a.obj"), scene).meshes[0].file, folder.path() / "scenes/a.obj");
    EXPECT_TRUE(fs::equivalent(parse(mesh_of("../objs/b.obj"), scene).meshes[0].file, folder.path() / "objs/b.obj"));
    EXPECT_EQ(parse(mesh_of((folder.path() / "objs/b.obj").string()), scene).meshes[0].file,
              folder.path() / "objs/b.obj");
}

TEST(SceneTest, FilesElsewhereNeedAnAllowedFolderLinksFollowed) {
    const TestFolder folder, other;
    other.write("c.obj", "");
    folder.write("objs/b.obj", "");
    fs::create_directories(folder.path() / "scenes");
    fs::create_symlink(other.path() / "c.obj", folder.path() / "scenes/link.obj");
    fs::create_symlink(other.path(), folder.path() / "scenes/elsewhere");
    const fs::path scene = folder.path() / "scenes/x.scene";
    Limits limits;
    for (const std::string& name : {std::string("link.obj"), std::string("elsewhere/c.obj"),
                                    (other.path() / "c.obj").string(), std::string("elsewhere/../scenes/link.obj")}) {
        limits.allowed_folders.clear();
        const std::string text = said_of(mesh_of(name), scene, limits);
        EXPECT_TRUE(contains(text, "--allow-path")) << text;
        limits.allowed_folders = {other.path().string() + "/"};
        if (name.ends_with("scenes/link.obj")) continue;  // a name that the other folder does not have
        EXPECT_EQ(said_of(mesh_of(name), scene, limits), "read");
    }
    // A folder whose name only begins like an allowed one is another folder.
    limits.allowed_folders = {other.path().string().substr(0, other.path().string().size() - 1)};
    EXPECT_TRUE(contains(said_of(mesh_of("link.obj"), scene, limits), "--allow-path"));
}

TEST(SceneTest, WhatIsNoRegularFileIsRefusedWithoutBeingOpened) {
    const TestFolder folder;
    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    fs::create_symlink("loop", folder.path() / "loop");
    const fs::path scene = folder.write("x.scene", mesh_of("x.scene"));
    EXPECT_TRUE(contains(said_of(mesh_of("pipe"), scene), "is a pipe"));
    EXPECT_TRUE(contains(said_of(mesh_of("."), scene), "is a folder"));
    EXPECT_TRUE(contains(said_of(mesh_of("loop"), scene), "x.scene:13:6: error: 'loop' cannot be"));
    EXPECT_TRUE(contains(said_of(mesh_of("x.scene"), scene), "is this scene itself"));
    Limits limits;
    limits.allowed_folders = {"/dev"};
    EXPECT_TRUE(contains(said_of(mesh_of("/dev/zero"), scene, limits), "is a device"));
}

TEST(SceneTest, AFileNamedInSeveralWaysIsOneFile) {
    const TestFolder folder;
    folder.write("objs/b.obj", "");
    fs::create_directories(folder.path() / "scenes");
    fs::create_symlink("../objs/b.obj", folder.path() / "scenes/link.obj");
    fs::create_hard_link(folder.path() / "objs/b.obj", folder.path() / "scenes/hard.obj");
    std::string text = std::string(viewer) + std::string(light);
    for (const std::string name :
         {"../objs/b.obj", "../objs/./b.obj", "../scenes/../objs/b.obj", "link.obj", "hard.obj"})
        text += "Mesh\ntexture PureTexture PLASTIC RED\nfile " + name + "\ncenter 0 0 0\nradius 1\n";
    const Scene scene = parse(text, folder.path() / "scenes/x.scene");
    ASSERT_EQ(scene.meshes.size(), 5u);
    for (const Mesh& mesh : scene.meshes) EXPECT_EQ(mesh.file, scene.meshes[0].file);
}

TEST(SceneTest, ANameLongerThanAnyIsRefusedAtOnce) {
    std::string name(32u << 20, '/');
    for (std::size_t i = 0; i + 2 < name.size(); i += 3) name[i] = name[i + 1] = '.';
    const std::string text = said_of(mesh_of(name));
    EXPECT_TRUE(contains(text, "is too long for the name of a file")) << text.substr(0, 500);
}

std::string read_said(const fs::path& file, const Limits& limits = {}) {
    std::vector<Diagnostic> warnings;
    try {
        read_scene(file, limits, warnings);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

TEST(SceneTest, ASceneThatIsNoRegularFileIsRefusedAtOnce) {
    const TestFolder folder;
    ASSERT_EQ(mkfifo((folder.path() / "pipe.scene").c_str(), 0600), 0);
    EXPECT_TRUE(contains(read_said(folder.path() / "pipe.scene"), "is a pipe"));
    EXPECT_TRUE(contains(read_said(folder.path()), "is a folder"));
    EXPECT_TRUE(contains(read_said("/dev/zero"), "is a device"));
    EXPECT_TRUE(contains(read_said("/proc/self/maps"), "is made up by the system"));
    EXPECT_TRUE(contains(read_said(folder.path() / "none.scene"), "No such file or directory"));
    EXPECT_TRUE(contains(read_said(folder.path() / std::string(300, 'x')), "File name too long"));
}

TEST(SceneTest, AFileOverTheBudgetIsNotRead) {
    const TestFolder folder;
    const fs::path huge = folder.write("huge.scene", "");
    fs::resize_file(huge, 1ull << 40);  // of holes
    EXPECT_TRUE(contains(read_said(huge), "has 1099511627776 bytes"));
    EXPECT_TRUE(contains(read_said(huge), "--max-scene-bytes"));
    const std::string text = std::string(viewer) + std::string(light) + std::string(sphere);
    const fs::path file = folder.write("x.scene", text);
    Limits limits;
    limits.scene_bytes = text.size();
    EXPECT_EQ(read_said(file, limits), "read");
    --limits.scene_bytes;
    EXPECT_TRUE(contains(read_said(file, limits), "--max-scene-bytes"));
}

TEST(SceneTest, ATextWithHolesIsRefusedUnread) {
    const TestFolder folder;
    const fs::path file = folder.write("x.scene", viewer);
    fs::resize_file(file, 60u << 20);
    EXPECT_EQ(read_said(file), file.string() +
                                   ": error: has holes, so it is no text\n  expected a scene file, such as "
                                   "scenes/cornell_box.scene");
}

}  // namespace
}  // namespace raywalk
