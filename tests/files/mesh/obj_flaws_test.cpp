// A broken detail of an OBJ file costs that detail, and is told of once.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "tests/files/mesh/obj_text.h"

namespace raywalk {
namespace {

std::size_t count_of(const std::string& text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
    return count;
}

// The square of two triangles, by four vertices that all are named.
constexpr std::string_view quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

void expect_quad(const TriangleMesh& mesh, const std::string& text) {
    EXPECT_EQ(mesh.positions, triangles_of(quad).positions) << text;
    EXPECT_EQ(mesh.faces, triangles_of(quad).faces) << text;
}

// --- what is no flaw ---

TEST(ObjFlaws, AByteOrderMarkLosesNoVertex) {
    const std::string mark = "\xEF\xBB\xBF", text(quad);
    for (const auto& [before, place, after] : std::vector<std::tuple<std::string, std::size_t, std::string>>{
             {"", 0, ""}, {mark, 0, ""}, {"# a\n", 0, ""}, {"", 0, " \t"}, {"", 8, ""}, {"", text.size(), ""}}) {
        std::string marked = text;
        marked.insert(place, mark + after).insert(0, before);
        const ReadMesh read(marked);
        expect_quad(read.mesh, marked);
        EXPECT_EQ(read.text, "");
    }
    // The line begins behind it.
    EXPECT_TRUE(contains(said_of_mesh(mark + "v 1 x 0\n" + text), "x.obj:1:5: warning: 'x'"));
}

TEST(ObjFlaws, CarriageReturnsEndLines) {
    std::string old_mac = "# a comment\ro name\r" + std::string(quad);
    std::ranges::replace(old_mac, '\n', '\r');
    const std::string text(quad);
    for (const std::string& ended :
         {old_mac, old_mac.substr(0, old_mac.size() - 1), "# note\r" + text, "g a\r" + text, "vt 0 0\r" + text,
          "vn 0 0 1\r" + text, "\r\r\n\r" + text, "v 0 0 0\rv 1 0 0\r\r" + text.substr(16)}) {
        const ReadMesh read(ended);
        expect_quad(read.mesh, ended);
        EXPECT_EQ(read.text, "");
    }
    EXPECT_TRUE(contains(said_of_mesh("# a\rv 0 0 x\r" + old_mac), "x.obj:2:7: warning: 'x'"));
}

// Lines are the same wherever pieces of the text, each for a thread, begin.
TEST(ObjFlaws, CarriageReturnsEndLinesOfLargeFiles) {
    std::string text(quad);
    while (text.size() < 2u << 20) text += "f 1 2 3\rf 1 3 4 # and more\rvt 0 0\r\nf 2 3 4\n";
    const ReadMesh read(text);
    EXPECT_EQ(read.mesh.faces.size(), 2 + count_of(text, "\rv") * 3);
    EXPECT_EQ(read.text, "");
}

TEST(ObjFlaws, ABackslashOfANameOrACommentContinuesNothing) {
    const std::string text(quad);
    for (const char* line : {"g parts\\", "# C:\\models\\", "usemtl wood\\ ", "o a\\\r", "mtllib .\\", "wibble \\",
                             "vn 0 0 1 # \\", "vt 0 0 # \\", "s 1\\"}) {
        const ReadMesh read(std::string(line) + ("\n" + text));
        expect_quad(read.mesh, line);
    }
    EXPECT_EQ(said_of_mesh("g parts\\\n" + text), "");
}

TEST(ObjFlaws, ABackslashThatEndsTheFileContinuesNothing) {
    for (const char* end : {"\\", " \\", "\\\n", "\\ ", "\\\r\n", " # \\"}) {
        const ReadMesh read(std::string(quad) + "f 1 2 3" + end);
        EXPECT_EQ(read.mesh.faces.size(), 3u) << end;
        EXPECT_EQ(read.text, "") << end;
    }
}

TEST(ObjFlaws, CommentsBehindDataAreIgnored) {
    const ReadMesh read(
        "v 0 0 0 # 1\nv 1 0 0# 2\nv 1 1 0#3\nv 0 1 0 1 #\nvn 0 0 1 # up\nf 1 2 3 # first\nf 1 3 4#second\n");
    expect_quad(read.mesh, "");
    EXPECT_EQ(read.text, "");
    // This number is none of Microsoft's.
    EXPECT_TRUE(contains(said_of_mesh("v 0 0 1.#QNAN\n" + std::string(quad)), "'1.#QNAN' is not a number"));
}

TEST(ObjFlaws, NumbersAfterTheLastExpectedAreIgnored) {
    const ReadMesh read(
        "v 0 0 0 1 .1 .2 .3 1\nv 1 0 0 1 2 3 4 5 6 and so on\nv 1 1 0\nv 0 1 0\nvn 0 0 1 1\nf 1//1 2 3\nf 1 3 4\n");
    expect_quad(read.mesh, "");
    EXPECT_EQ(read.text, "");
}

// --- what costs a detail ---

TEST(ObjFlaws, AVertexThatCannotBeReadKeepsItsNumber) {
    for (const char* line :
         {"v 1 2", "v a b c", "v nan 0 0", "v 0 1e39 0", "v", "v 0,5 1 0", "v 1 2 # 3", "v -nan(ind) 0 0"}) {
        const ReadMesh read(std::string(line) +
                            ("\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4\nf -4 -2 -1\nf 1 2 3\nf 2 3 4 1\n"));
        expect_quad(read.mesh, line);
        EXPECT_TRUE(contains(read.text, "1 vertex cannot be read")) << read.text;
        EXPECT_TRUE(contains(read.text, "x.obj:8:3: warning: vertex 1 cannot be read: 2 faces are left out"))
            << read.text;
        EXPECT_EQ(read.warnings.size(), 2u);
    }
    // One that no face names is none of their matter.
    EXPECT_EQ(ReadMesh(std::string(quad) + "v x\n").warnings.size(), 1u);
}

TEST(ObjFlaws, AFaceThatNamesWhatIsNotThereIsLeftOutWhole) {
    for (const char* face : {"f 1 2 5", "f 1 2 3 99", "f 0 1 2", "f 1 2 -5", "f 1 2 99999999999999999999 3",
                             "f 5 1 2 3 4", "f 1/1 2 \\\n 9/1"}) {
        const ReadMesh read(std::string(quad) + face + "\n");
        expect_quad(read.mesh, face);
        EXPECT_TRUE(contains(read.text, "there is no vertex ")) << read.text;
        EXPECT_TRUE(contains(read.text, ": 1 face is left out")) << read.text;
        EXPECT_EQ(read.warnings.size(), 1u);
    }
}

TEST(ObjFlaws, AFaceThatIsNoneIsLeftOut) {
    for (const char* face :
         {"f", "f 1", "f 1 2", "f 1 2 # 3", "f 1 2 x", "f 1 2 3.5", "f a", "f 1 2 3 4 -", "f 1\\2 3", "f /1 2 3"}) {
        const ReadMesh read(std::string(quad) + face + "\n" + face + "\n");
        expect_quad(read.mesh, face);
        EXPECT_TRUE(contains(read.text, ": 2 faces are left out")) << read.text;
        EXPECT_EQ(read.warnings.size(), 1u);
    }
}

TEST(ObjFlaws, WhatIsWrongBehindTheVertexCostsTheNormal) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 3 4\n";
    for (const char* face : {"f 1//2 2 3", "f 1//0 2 3", "f 1//-2 2 3", "f 1/x/9 2 3", "f 1/1/9/1 2 3", "f 1//y 2 3"}) {
        const ReadMesh read(vertices + face + "\n");
        EXPECT_EQ(read.mesh.faces, (std::vector<Corners>{{0, 2, 3}, {0, 1, 2}})) << face;
        EXPECT_EQ(read.mesh.normal_faces, (std::vector<NormalCorners>{{0, -1, -1}, {-1, -1, -1}})) << face;
        EXPECT_FALSE(read.warnings.empty()) << face;
    }
    // A normal that can be read counts.
    EXPECT_EQ(ReadMesh(vertices + "f 1/x/1 2/1/1/1 3").mesh.normal_faces[1], (NormalCorners{0, 0, -1}));
}

TEST(ObjFlaws, NormalsThatAreNoneComeFromTheFaces) {
    for (const char* normal :
         {"vn nan nan nan", "vn 0 0 1e60", "vn -nan(ind) 0 0", "vn inf 0 0", "vn 1 2", "vn", "vn 0 0 0", "vn a 0 1"}) {
        const std::string text = std::string(normal) + ("\nvn 0 1 0\n" + std::string(quad));
        const ReadMesh unused(text), used(text + "f 1//1 2//2 3//1\n");
        expect_quad(unused.mesh, normal);
        EXPECT_EQ(unused.warnings.size(), 1u) << unused.text;
        EXPECT_EQ(used.mesh.normal_faces.back(), (NormalCorners{-1, 1, -1})) << normal;
        for (const glm::vec3& n : used.mesh.normals) EXPECT_TRUE(std::isfinite(n.x + n.y + n.z));
    }
}

TEST(ObjFlaws, ColoursThatAreNoneAreIgnored) {
    for (const char* colour : {"nan 0 0", "1e60 1 1", "red", "1 1 -inf"}) {
        std::string text = std::string(quad);
        text.insert(7, std::string(" ") + colour);
        const ReadMesh read(text);
        expect_quad(read.mesh, text);
        EXPECT_TRUE(contains(read.text, "1 weight or colour is ignored")) << read.text;
    }
}

// --- how they are told of ---

TEST(ObjFlaws, AreToldOfOnceForEachKindWithTheFirstPlaceAndTheirCount) {
    std::string text(quad);
    for (int i = 0; i < 1000; ++i) text += "f 1 2 9\nf 1 x 2\nf 3\nv nan 0 0\nvn 0 0 0\nwibble\n";
    const ReadMesh read(text);
    EXPECT_EQ(read.warnings.size(), 6u);
    EXPECT_TRUE(contains(read.text, "x.obj:8:5: warning: 'x' is not a corner: 1000 faces are left out")) << read.text;
    EXPECT_TRUE(contains(read.text, "x.obj:10:3: warning: 'nan' is not a finite number: 1000 vertices cannot be read"));
    EXPECT_TRUE(contains(read.text, "x.obj:11:1: warning: 1000 normals have no length"));
    EXPECT_TRUE(contains(read.text, "x.obj:12:1: warning: unknown statement 'wibble': 1000 lines are ignored"));
}

TEST(ObjFlaws, AreTheSameForAnyNumberOfThreads) {
    std::string text = "v 0 0 x\n" + std::string(quad);
    while (text.size() < 3u << 20) text += "f 2 3 4\nf 1 2 3 # lost\nf 2 3 999999999\nv 1 2 3\n";
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const ReadMesh alone(text);
    omp_set_num_threads(7);
    const ReadMesh together(text);
    omp_set_num_threads(threads);
    EXPECT_EQ(alone.text, together.text);
    EXPECT_EQ(alone.mesh.faces, together.mesh.faces);
    EXPECT_TRUE(contains(alone.text, "x.obj:6:3: warning: vertex 1 cannot be read: ")) << alone.text;
}

TEST(ObjFlaws, OnlyWhatLeavesNoPictureIsAnError) {
    EXPECT_TRUE(contains(said_of_mesh("v 0 0 0\n"), "error: has no faces"));
    EXPECT_TRUE(contains(said_of_mesh("f 1 2 3\n"), "error: has no face that can be read"));
    EXPECT_TRUE(contains(said_of_mesh("v 0 0 0\nf 1 2\n"), "x.obj:2:1: warning: a face of 2 corners"));
    EXPECT_TRUE(contains(said_of_mesh("\xFF\xFEv"), "error: is UTF-16 text"));
}

TEST(ObjFlaws, VerticesThatNoFaceNamesAreLeftOut) {
    const ReadMesh read("v 9 9 9\nv 0 0 0\nv 1e30 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 7 7 7\nf 2 4 5\nf -6 -3 -2\n");
    expect_quad(read.mesh, "");
    EXPECT_EQ(read.text, "");
}

}  // namespace
}  // namespace raywalk
