#include <gtest/gtest.h>
#include <omp.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>
#include <thread>

#include "tests/files/folder.h"
#include "tests/files/mesh/obj_naive.h"
#include "tests/files/mesh/obj_text.h"
#include "tests/fuzz/targets.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {
namespace {

void expect_same_triangles(const TriangleMesh& a, const TriangleMesh& b) {
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_TRUE(a.faces == b.faces);
    EXPECT_TRUE(a.normals == b.normals);
    EXPECT_TRUE(a.normal_faces == b.normal_faces);
}

TEST(ObjTest, EveryIndexFormNamesTheSameTriangle) {
    const std::vector<Corners> expected = {{0, 1, 2}};
    const std::vector<NormalCorners> none, both = {{0, 0, 1}};
    const std::pair<const char*, const std::vector<NormalCorners>&> cases[] = {
        {"f 1 2 3", none},
        {"f 1/1 2/1 3/1", none},
        {"f 1//1 2//1 3//2", both},
        {"f 1/1/1 2/1/1 3/1/2", both},
        {"f -4 -3 -2", none},
        {"f 1 -3 3", none},
        {"f -4/-1 2/1 -2/1", none},
        {"f -4//-2 2//-2 -2//2", both},
        {"f\t1/1/1  2/1/1\t 3/1/2 \t\r", both},
        {"  f 1 2 3", none},
        {"f 1 \\\n 2 \\\r\n3", none},
        {"f 1\\\n 2 3", none},
        {"f 1/ 2// 3/1/", none},
        {"f 1// 2// 3//\r\n", none},
        {"f +1 +2 +3", none},
        {"f +1/+1/+1 +2//+1 +3//-1", both},
        {"f 1 2 3 # 4", none},
        {"f 1//1 2//1 3//2# 4", both},
        {"f 1 2 3 # \\\nf 1 2", none},
        {"f 1 \\ \t\n2 \\  \r\n3", none},
        {"f 1 2 3\\", none},
        {"f 1 2 3 \\ ", none},
        {"\xEF\xBB\xBF"
         "f 1 2 3",
         none},
    };
    for (const auto& [face, normals] : cases) {
        const TriangleMesh mesh = triangles_of(std::string(square) + face);
        EXPECT_EQ(mesh.faces, expected) << face;
        EXPECT_EQ(mesh.positions.size(), 3u);  // the fourth is not named
        EXPECT_EQ(mesh.normal_faces, normals) << face;
    }
}

TEST(ObjTest, PolygonsAreFansFromTheirFirstCorner) {
    const TriangleMesh mesh = triangles_of(std::string(square) + "v -.5 .5 0\nf 2 3//1 4 5 1\nf 1 2 3\n");
    EXPECT_EQ(mesh.faces, (std::vector<Corners>{{1, 2, 3}, {1, 3, 4}, {1, 4, 0}, {0, 1, 2}}));
    EXPECT_EQ(mesh.normal_faces, (std::vector<NormalCorners>{{-1, 0, -1}, {-1, -1, -1}, {-1, -1, -1}, {-1, -1, -1}}));
}

TEST(ObjTest, FacesMayStandBeforeTheirVertices) {
    EXPECT_EQ(triangles_of("f 1 2 3\n" + std::string(square)).faces, (std::vector<Corners>{{0, 1, 2}}));
    EXPECT_TRUE(contains(said_of_mesh("f -1 -2 -3\n" + std::string(square)), "not so many vertices stand above"));
}

TEST(ObjTest, WeightsColoursAndSigns) {
    const TriangleMesh mesh =
        triangles_of("v +1 -2 .5\nv 1. 2e0 3E-1 1\nv 0 0 0 0.1 0.2 0.3\nv 1 2 3 1 0.1 0.2 0.3\nf 1 2 3\nf 1 2 4");
    EXPECT_EQ(mesh.positions[0], glm::vec3(1, -2, 0.5f));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 2, 0.3f));
    EXPECT_EQ(mesh.positions[3], glm::vec3(1, 2, 3));
}

// Names every vertex, so that all are kept.
std::string faces_of_all(std::size_t vertices) {
    std::string text = "\n";
    for (std::size_t v = 1; v <= vertices; ++v) text += "f 1 2 " + std::to_string(v) + "\n";
    return text;
}

// Each number is the float nearest to what is written, however it is written.
TEST(ObjTest, NumbersAreCorrectlyRounded) {
    std::mt19937 random(7);
    std::string text;
    std::vector<float> expected;
    const auto add = [&](const std::string& number) {
        text += (expected.size() % 3 == 0 ? "\nv " : " ") + number;
        expected.push_back(std::strtof(number.c_str(), nullptr));
    };
    for (int i = 0; i < 30000; ++i) {
        const auto f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(f)) continue;
        char buffer[400];
        constexpr const char* forms[] = {"%.6f", "%.9g", "%g", "%.3e", "%.17g", "%.2f"};
        std::snprintf(buffer, sizeof buffer, forms[i % 6], static_cast<double>(f));
        if (std::isfinite(std::strtof(buffer, nullptr))) add(buffer);
        std::snprintf(buffer, sizeof buffer, "%d.%0*u", static_cast<int>(random() % 2001) - 1000,
                      1 + static_cast<int>(random() % 9), static_cast<unsigned>(random() % 10));
        add(buffer);
    }
    // Half-way between two floats, and next to it: 2^24 + 1 is the first whole number that is no float.
    for (const char* edge :
         {"16777216", "16777217", "16777218", "16777219", "1.6777217", "16777217.0", "0.16777217", "8388608.5",
          "8388609.5", "3.4028235e38", "1e-45", "7e-46", "1e-60", "-0", "-0.0", "00000000000000000000000001",
          "0.00000000000000000000000000000000000001", "123456789012345678901234567890", "1e-400"})
        add(edge);
    while (expected.size() % 3 != 0) add("0");
    const TriangleMesh mesh = triangles_of(text + faces_of_all(expected.size() / 3));
    ASSERT_EQ(mesh.positions.size() * 3, expected.size());
    const auto* got = reinterpret_cast<const float*>(mesh.positions.data());
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(got[i]), std::bit_cast<std::uint32_t>(expected[i])) << expected[i];
}

// Where rounding twice would go wrong: the middle of two floats, its neighbours in double precision, cut to any number
// of digits.
TEST(ObjTest, NumbersNearTheMiddleOfTwoFloatsAreCorrectlyRounded) {
    std::mt19937 random(11);
    std::string text;
    std::vector<float> expected;
    for (int i = 0; i < 90000; ++i) {
        const auto bits = static_cast<std::uint32_t>((100 + random() % 60) << 23 | (random() & 0x7FFFFF));
        const auto f = std::bit_cast<float>(bits);  // between 2^-27 and 2^33
        const double middle = 0.5 * (double{f} + double{std::nextafter(f, 1e30f)});
        const auto near = std::bit_cast<double>(std::bit_cast<std::uint64_t>(middle) + random() % 9 - 4);
        char buffer[80];
        std::snprintf(buffer, sizeof buffer, i % 4 == 0 ? "%.*f" : "%.*g", static_cast<int>(7 + random() % 24), near);
        text += (i % 3 == 0 ? "\nv " : " ") + std::string(buffer);
        expected.push_back(std::strtof(buffer, nullptr));
    }
    const TriangleMesh mesh = triangles_of(text + faces_of_all(expected.size() / 3));
    ASSERT_EQ(mesh.positions.size() * 3, expected.size());
    const auto* got = reinterpret_cast<const float*>(mesh.positions.data());
    for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(got[i]), std::bit_cast<std::uint32_t>(expected[i])) << expected[i];
}

TEST(ObjTest, OtherStatementsAreIgnoredAndUnknownOnesWarnedOfOnce) {
    std::vector<Diagnostic> warnings;
    const std::string text = "mtllib a.mtl\no a\ng a b\ns off\nusemtl x\nvp 1\nl 1 2\np 1\n# f 1 1 1 \\\n" +
                             std::string(square) + "f 1 2 3\n";
    parse_obj(text, "x.obj", {}, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(parse_obj(text + "wibble 1\nwobble 2 \\\n 3\n", "x.obj", {}, warnings).faces.size(), 1u);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(contains(to_string(warnings[0]), "x.obj:18:1: warning: unknown statement 'wibble'"));
}

TEST(ObjTest, ANormalWithoutLengthIsNone) {
    std::vector<Diagnostic> warnings;
    const std::string text = std::string(square) + "vn 0 0 0\nvn 1e-30 0 0\nvn 3e38 3e38 0\nf 1//3 2//4 3//5\n";
    const TriangleMesh mesh = parse_obj(text, "x.obj", {}, warnings);
    EXPECT_EQ(mesh.normal_faces, (std::vector<std::array<std::int32_t, 3>>{{-1, 3, 4}}));
    EXPECT_EQ(mesh.normals[3], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[4], glm::vec3(1, 1, 0));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(contains(to_string(warnings[0]), "1 normal has no length"));
}

// --- several pieces at once ---

TEST(ObjTest, TheMeshIsThatOfANaiveReaderForAnyNumberOfThreads) {
    const int threads = omp_get_max_threads();
    for (unsigned seed = 0; seed < 3; ++seed) {
        const std::string text = random_obj(seed, 3u << 20);  // several pieces
        const TriangleMesh naive = parse_naively(text);
        ASSERT_GT(naive.faces.size(), 10000u);
        for (const int count : {1, 2, 7}) {
            omp_set_num_threads(count);
            expect_same_triangles(naive, triangles_of(text));
        }
        omp_set_num_threads(threads);
    }
}

TEST(ObjTest, MistakesFarIntoALargeFileHaveTheirLine) {
    std::string text = std::string(square);
    while (text.size() < 2u << 20) text += "f 1//1 2//1 3//1 4//2\n# and a comment\nvn 0 0 1\r\n";
    const std::string place = "x.obj:" + std::to_string(std::ranges::count(text, '\n') + 1);
    const std::string next_place = "x.obj:" + std::to_string(std::ranges::count(text, '\n') + 2);
    const auto said = [&](std::string_view line) { return said_of_mesh(text + std::string(line) + text); };
    EXPECT_TRUE(contains(said("f 1 2 x\n"), place + ":7: warning: 'x' is not a corner"));
    EXPECT_TRUE(contains(said("f 1 2 99999999\n"), place + ":7: warning: there is no vertex 99999999"));
    EXPECT_TRUE(contains(said("f 1 2 1 \\\n -9999999/1/1\n"), next_place + ":2: warning: there is no vertex -9999999"));
    EXPECT_TRUE(contains(said("f 1 2 1//99999999\n"), place + ":10: warning: there is no normal 99999999"));
}

TEST(ObjTest, MutatedFilesAreReadOrRefusedWithAPlace) {
    std::mt19937 random(3);
    const std::string whole = random_obj(9, 4000);
    for (int round = 0; round < 3000; ++round) {
        std::string text = whole.substr(random() % 2000, random() % 1500);
        for (int i = 0; i < 4 && !text.empty(); ++i) {
            const std::size_t at = random() % text.size();
            if (random() % 2)
                text[at] = static_cast<char>(random());
            else
                text.insert(at, 1, "\\\n/-0 fv#\r+"[random() % 11]);
        }
        fuzz::obj(text);
    }
}

// --- budgets and odd files ---

TEST(ObjTest, TrianglesAreCountedBeforeMemoryIsTaken) {
    Limits limits;
    limits.triangles = 3;
    const std::string three = std::string(square) + "f 1 2 3 4\nf 1 2 3\n";
    EXPECT_EQ(said_of_mesh(three, limits), "");
    EXPECT_TRUE(contains(said_of_mesh(three + "f 1 2 3\n", limits), "--max-triangles"));
    std::string bomb = std::string(square) + "f";
    for (int i = 0; i < 1'000'000; ++i) bomb += " 1";
    EXPECT_TRUE(contains(said_of_mesh(bomb, limits), "--max-triangles"));
}

TEST(ObjTest, AFileOverTheBudgetIsNotRead) {
    const TestFolder folder;
    const auto huge = folder.write("huge.obj", "");
    std::filesystem::resize_file(huge, 1ull << 42);
    std::vector<Diagnostic> warnings;
    try {
        read_obj(huge, {}, warnings, {"x.scene", 4, 6, 3});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_TRUE(contains(error.what(), "x.scene:4:6: error: '")) << error.what();
        EXPECT_TRUE(contains(error.what(), "--max-mesh-bytes")) << error.what();
    }
}

TEST(ObjTest, WhatIsNoRegularFileIsRefusedAtOnce) {
    const TestFolder folder;
    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    const std::pair<std::filesystem::path, const char*> cases[] = {
        {folder.path() / "pipe", "is a pipe"}, {folder.path(), "is a folder"}, {"/dev/zero", "is a device"}};
    for (const auto& [file, reason] : cases) {
        std::vector<Diagnostic> warnings;
        try {
            read_obj(file, {}, warnings);
            FAIL() << file;
        } catch (const InputError& error) {
            EXPECT_TRUE(contains(error.what(), reason)) << error.what();
        }
    }
}

// A file that is written to, cut and grown while it is read: refused or read, never a crash (a mapping would die).
TEST(ObjTest, AFileThatChangesWhileItIsReadDoesNoHarm) {
    const TestFolder folder;
    const std::string text = random_obj(1, 3u << 20);
    const auto file = folder.write("x.obj", text);
    std::atomic<bool> stop{false};
    std::thread writer([&] {
        for (unsigned i = 0; !stop; ++i) {
            std::filesystem::resize_file(file, i % 2 ? text.size() : text.size() / 3);
            if (i % 2) folder.write("x.obj", text);
        }
    });
    int cut = 0;  // or refused
    const std::size_t all = triangles_of(text).faces.size();
    for (int i = 0; i < 30; ++i) {
        std::vector<Diagnostic> warnings;
        try {
            if (read_obj(file, {}, warnings).faces.size() < all) ++cut;
        } catch (const InputError&) {
            ++cut;
        }
    }
    stop = true;
    writer.join();
    folder.write("x.obj", text);
    std::vector<Diagnostic> warnings;
    EXPECT_FALSE(read_obj(file, {}, warnings).faces.empty());
    EXPECT_GT(cut, 0);
}

}  // namespace
}  // namespace raywalk
