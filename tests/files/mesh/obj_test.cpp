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
#include "tracer/files/mesh/obj_reader.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {
namespace {

using Corners = std::array<std::uint32_t, 3>;

TriangleMesh triangles_of(std::string_view text, const Limits& limits = {}) {
    std::vector<Diagnostic> warnings;
    return parse_obj(text, "x.obj", limits, warnings);
}

std::string said_of_mesh(std::string_view text, const Limits& limits = {}) {
    try {
        triangles_of(text, limits);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

void expect_same_triangles(const TriangleMesh& a, const TriangleMesh& b) {
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_TRUE(a.faces == b.faces);
    EXPECT_TRUE(a.normals == b.normals);
    EXPECT_TRUE(a.normal_faces == b.normal_faces);
}

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvt 0 0\n";

TEST(ObjTest, EveryIndexFormNamesTheSameTriangle) {
    const std::vector<Corners> expected = {{0, 1, 2}};
    for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//2", "f 1/1/1 2/1/1 3/1/2", "f -4 -3 -2",
                             "f 1 -3 3", "f -4/-1 2/1 -2/1", "f -4//-2 2//-2 -2//2", "f\t1/1/1  2/1/1\t 3/1/2 \t\r",
                             "  f 1 2 3", "f 1 \\\n 2 \\\r\n3", "f 1\\\n 2 3"}) {
        const TriangleMesh mesh = triangles_of(std::string(square) + face);
        EXPECT_EQ(mesh.faces, expected) << face;
        EXPECT_EQ(mesh.positions.size(), 4u);
        if (contains(face, "//") || contains(face, "/1/")) {
            EXPECT_EQ(mesh.normal_faces, (std::vector<std::array<std::int32_t, 3>>{{0, 0, 1}})) << face;
        } else {
            EXPECT_TRUE(mesh.normal_faces.empty()) << face;
        }
    }
}

TEST(ObjTest, PolygonsAreFansFromTheirFirstCorner) {
    const TriangleMesh mesh = triangles_of(std::string(square) + "v 0 2 0\nf 2 3//1 4 5 1\nf 1 2 3\n");
    EXPECT_EQ(mesh.faces, (std::vector<Corners>{{1, 2, 3}, {1, 3, 4}, {1, 4, 0}, {0, 1, 2}}));
    EXPECT_EQ(mesh.normal_faces,
              (std::vector<std::array<std::int32_t, 3>>{{-1, 0, -1}, {-1, -1, -1}, {-1, -1, -1}, {-1, -1, -1}}));
}

TEST(ObjTest, FacesMayStandBeforeTheirVertices) {
    EXPECT_EQ(triangles_of("f 1 2 3\n" + std::string(square)).faces, (std::vector<Corners>{{0, 1, 2}}));
    EXPECT_TRUE(contains(said_of_mesh("f -1 -2 -3\n" + std::string(square)), "not so many vertices stand above"));
}

TEST(ObjTest, WeightsColoursAndSigns) {
    const TriangleMesh mesh =
        triangles_of("v +1 -2 .5\nv 1. 2e0 3E-1 1\nv 0 0 0 0.1 0.2 0.3\nv 1 2 3 1 0.1 0.2 0.3\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], glm::vec3(1, -2, 0.5f));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 2, 0.3f));
    EXPECT_EQ(mesh.positions[3], glm::vec3(1, 2, 3));
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
    const TriangleMesh mesh = triangles_of(text + "\nf 1 2 3\n");
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
    const TriangleMesh mesh = triangles_of(text + "\nf 1 2 3\n");
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

// A large file with every way to write things, random but for its seed.
std::string random_obj(unsigned seed, std::size_t bytes) {
    std::mt19937 random(seed);
    const auto below = [&](std::size_t n) { return random() % n; };
    const auto number = [&] { return std::to_string(static_cast<double>(static_cast<int>(random())) * 1e-7); };
    std::string text = "v 0 0 0\nv 1 1 1\nvn 0 0 1\nvt 0 0\n";
    std::size_t vertices = 2, normals = 1;
    const auto end = [&] { return std::string(below(5) ? "\n" : below(2) ? " \r\n" : "\t\n"); };
    while (text.size() < bytes) {
        switch (below(8)) {
            case 0:
            case 1:
                text += "v " + number() + " " + number() + "  " + number() + end(), ++vertices;
                break;
            case 2:
                text += "vn " + number() + "\t" + number() + " 1" + end(), ++normals;
                break;
            case 3:
                text += "# a comment " + std::string(below(80), 'x') + end();
                break;
            case 4:
                text += below(2) ? "\n" : "usemtl red \\\n v 1 2 3\n";
                break;
            default: {
                text += "f";
                for (std::size_t corner = 3 + below(4); corner > 0; --corner) {
                    const std::size_t v = 1 + below(vertices), n = 1 + below(normals);
                    text += below(10) ? " " : " \\\n ";
                    text += below(2) ? std::to_string(v) : "-" + std::to_string(vertices + 1 - v);
                    const std::string normal = below(2) ? std::to_string(n) : "-" + std::to_string(normals + 1 - n);
                    if (const auto form = below(4); form == 1)
                        text += "/1";
                    else if (form == 2)
                        text += "//" + normal;
                    else if (form == 3)
                        text += "/1/" + normal;
                }
                text += end();
            }
        }
    }
    return text;
}

// The same file read word by word, one after the other.
TriangleMesh parse_naively(std::string text) {
    for (std::size_t at = 0; (at = text.find("\\\n", at)) != std::string::npos;) text.replace(at, 2, "  ");
    TriangleMesh mesh;
    std::vector<std::array<std::int32_t, 3>> normal_faces;
    bool any_normal = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word, x, y, z;
        words >> word;
        if (word == "v" || word == "vn") {
            words >> x >> y >> z;
            (word == "v" ? mesh.positions : mesh.normals).emplace_back(std::stof(x), std::stof(y), std::stof(z));
        } else if (word == "f") {
            std::vector<std::pair<std::uint32_t, std::int32_t>> corners;
            while (words >> word) {
                const auto index = [](int i, std::size_t count) { return i < 0 ? static_cast<int>(count) + i : i - 1; };
                const std::size_t slash = word.rfind('/');
                const bool normal = slash != std::string::npos && word.find('/') != slash;
                any_normal |= normal;
                corners.emplace_back(index(std::stoi(word), mesh.positions.size()),
                                     normal ? index(std::stoi(word.substr(slash + 1)), mesh.normals.size()) : -1);
            }
            for (std::size_t i = 2; i < corners.size(); ++i) {
                mesh.faces.push_back({corners[0].first, corners[i - 1].first, corners[i].first});
                normal_faces.push_back({corners[0].second, corners[i - 1].second, corners[i].second});
            }
        }
    }
    if (any_normal) mesh.normal_faces = normal_faces;
    return mesh;
}

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
    std::string text = random_obj(5, 2u << 20);
    const auto line = std::ranges::count(text, '\n') + 1;
    const std::string place = "x.obj:" + std::to_string(line);
    EXPECT_TRUE(contains(said_of_mesh(text + "f 1 2 x\n" + random_obj(6, 1u << 20)), place + ":7: error: 'x'"));
    EXPECT_TRUE(contains(said_of_mesh(text + "f 1 2 99999999\n"), place + ":7: error: there is no vertex 99999999"));
    EXPECT_TRUE(contains(said_of_mesh(text + "f 1 2 1 \\\n -9999999/1/1\n"),
                         "x.obj:" + std::to_string(line + 1) + ":2: error: there is no vertex -9999999"));
    EXPECT_TRUE(
        contains(said_of_mesh(text + "f 1 2 1//99999999\n"), place + ":10: error: there is no normal 99999999"));
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
                text.insert(at, 1, "\\\n/-0 fv"[random() % 8]);
        }
        const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
        try {
            const TriangleMesh mesh = triangles_of(text);
            for (const Corners& face : mesh.faces)
                for (const std::uint32_t corner : face) ASSERT_LT(corner, mesh.positions.size());
            for (const auto& face : mesh.normal_faces)
                for (const std::int32_t corner : face)
                    ASSERT_LT(corner, static_cast<std::int32_t>(mesh.normals.size()));
        } catch (const InputError& error) {
            for (const Diagnostic& d : error.diagnostics()) {
                EXPECT_LE(d.where.line, lines);
                EXPECT_LT(to_string(d).size(), 1000u);
            }
        }
    }
}

// --- budgets and odd files ---

TEST(ObjTest, TrianglesAreCountedBeforeMemoryIsTaken) {
    Limits limits;
    limits.triangles = 3;
    const std::string three = std::string(square) + "f 1 2 3 4\nf 1 2 3\n";
    EXPECT_EQ(said_of_mesh(three, limits), "read");
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
    int refused = 0;
    for (int i = 0; i < 30; ++i) {
        std::vector<Diagnostic> warnings;
        try {
            read_obj(file, {}, warnings);
        } catch (const InputError&) {
            ++refused;
        }
    }
    stop = true;
    writer.join();
    folder.write("x.obj", text);
    std::vector<Diagnostic> warnings;
    EXPECT_FALSE(read_obj(file, {}, warnings).faces.empty());
    EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace raywalk
