// Meshes far from the origin are moved before they are rounded; others keep their bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "tests/files/mesh/obj_text.h"

namespace raywalk {
namespace {

// A ball of radius 1, of quads, around a place; with statements between and a vertex at 0 that no face names.
std::string ball_at(const glm::dvec3& place, double radius, const char* before = "v 0 0 0\n") {
    std::string text = before;
    char line[200];
    constexpr int rings = 40, segments = 80;
    for (int ring = 0; ring <= rings; ++ring)
        for (int s = 0; s < segments; ++s) {
            const double polar = M_PI * ring / rings, turn = 2 * M_PI * s / segments;
            const glm::dvec3 p(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
            const glm::dvec3 at = place + radius * p;
            std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", at.x, at.y, at.z);
            text += line;
        }
    for (int ring = 0; ring < rings; ++ring)
        for (int s = 0; s < segments; ++s) {
            const int a = ring * segments + s + 1, b = ring * segments + (s + 1) % segments + 1;
            std::snprintf(line, sizeof line, "f %d %d %d %d\n", a - 1 - (rings + 1) * segments,
                          b - 1 - (rings + 1) * segments, b + segments - 1 - (rings + 1) * segments,
                          a + segments - 1 - (rings + 1) * segments);
            text += line;
        }
    return text;
}

// The largest distance of a vertex from the ball, as a part of its radius.
double distance_from_ball(const TriangleMesh& mesh, const glm::dvec3& place, double radius) {
    double largest = 0;
    for (const glm::vec3& p : mesh.positions)
        largest = std::max(largest, std::abs(glm::length(glm::dvec3(p) + mesh.origin - place) / radius - 1));
    return largest;
}

TEST(ObjOrigin, MeshesInCoordinatesOfAMapAreNotRoundedToSteps) {
    const glm::dvec3 utm(500000.25, 4649776.5, 120);
    for (const double scale : {1.0, -1.0, 10.0}) {
        const glm::dvec3 place = utm * scale;
        const TriangleMesh mesh = triangles_of(ball_at(place, 1));
        EXPECT_NE(mesh.origin, glm::dvec3(0));
        EXPECT_LT(glm::length(mesh.origin - place), 1 + 4);  // the ball's radius, and a float's step at 4e7
        EXPECT_LT(distance_from_ball(mesh, place, 1), 1e-6);
        EXPECT_EQ(mesh.faces.size(), 6400u);
    }
}

// However the file is written, also where a look at a few lines tells nothing.
TEST(ObjOrigin, IsFoundWhereverTheVerticesStand) {
    const glm::dvec3 place(500000, 4649776, 0);
    std::string late = "# " + std::string(200'000, 'x') + "\n" + ball_at(place, 0.5);
    std::string indented = ball_at(place, 0.5);
    for (std::size_t at = 0; (at = indented.find("\nv ", at)) != std::string::npos; at += 3)
        indented.replace(at, 3, "\n v\t");
    std::string old_mac = ball_at(place, 0.5);
    std::ranges::replace(old_mac, '\n', '\r');
    const std::string broken = ball_at(place, 0.5) + "f -1 -2 999999\nv x\n";
    std::string other = "v 0 0 0\n";
    for (int i = 0; i < 20000; ++i) other += "v 1 2 " + std::to_string(i) + "\n";  // of no face
    for (const std::string& text : {late, indented, old_mac, broken, other + ball_at(place, 0.5)}) {
        const TriangleMesh mesh = triangles_of(text);
        EXPECT_LT(distance_from_ball(mesh, place, 0.5), 1e-6);
        EXPECT_EQ(mesh.faces.size(), 6400u);
    }
}

TEST(ObjOrigin, MeshesNearTheOriginKeepTheirBits) {
    for (const double distance : {0.0, 1.0, 5.0, 30.0}) {
        const TriangleMesh mesh = triangles_of(ball_at({distance, -distance, 0}, 1, "v 0 0 0\nv 0 0 0\n"));
        EXPECT_EQ(mesh.origin, glm::dvec3(0)) << distance;
    }
    // A look at a few lines takes it for far away.
    std::string text = "v 1000.1 0.1 0.3\nv 0 0 0\n";
    for (int i = 0; i < 20000; ++i) text += "v 1000.1 0.1 " + std::to_string(i % 7) + ".3\n";
    for (int i = 1; i < 20000; ++i) text += "f " + std::to_string(i) + " 2 " + std::to_string(i + 1) + "\n";
    const TriangleMesh mesh = triangles_of(text);
    EXPECT_EQ(mesh.origin, glm::dvec3(0));
    EXPECT_EQ(mesh.positions[0], glm::vec3(1000.1f, 0.1f, 0.3f));
}

TEST(ObjOrigin, HugeAndTinyCoordinatesDoNoHarm) {
    for (const char* number : {"3e38", "-3e38", "1e-40", "1e300", "inf", "nan", "99999999999999999999"}) {
        std::string text;
        for (int i = 0; i < 3; ++i) text += std::string("v ") + number + " " + std::to_string(i) + " " + number + "\n";
        for (const glm::vec3& p : ReadMesh(text + "f 1 2 3\n").mesh.positions)
            EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
    }
}

}  // namespace
}  // namespace raywalk
