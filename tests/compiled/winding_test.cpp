// Faces that are listed the other way round than their neighbours.
#include "tracer/compiled/winding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tracer/compiled/mesh_placement.h"

namespace raywalk {
namespace {

// A ball around a place, wound so that its faces point outwards; without its last rings it is open.
TriangleMesh wound_ball(glm::vec3 place = glm::vec3(0), std::uint32_t rings_left_out = 0) {
    constexpr std::uint32_t rings = 12, segments = 24;
    TriangleMesh mesh;
    const auto add = [&](double polar, double turn) {
        mesh.positions.push_back(
            place + glm::vec3(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)));
    };
    add(0, 0);
    for (std::uint32_t ring = 1; ring < rings; ++ring)
        for (std::uint32_t s = 0; s < segments; ++s) add(M_PI * ring / rings, 2 * M_PI * s / segments);
    add(M_PI, 0);
    const auto vertex = [&](std::uint32_t ring, std::uint32_t s) {
        return ring == 0 ? 0u : ring == rings ? 1 + (rings - 1) * segments : 1 + (ring - 1) * segments + s % segments;
    };
    for (std::uint32_t ring = 0; ring < rings - rings_left_out; ++ring)
        for (std::uint32_t s = 0; s < segments; ++s) {
            if (ring > 0) mesh.faces.push_back({vertex(ring, s), vertex(ring, s + 1), vertex(ring + 1, s + 1)});
            if (ring + 1 < rings) mesh.faces.push_back({vertex(ring, s), vertex(ring + 1, s + 1), vertex(ring + 1, s)});
        }
    return mesh;
}

void turn(std::array<std::uint32_t, 3>& face) { std::swap(face[1], face[2]); }

// Turns a share of the faces at random; says which.
std::vector<std::uint8_t> turn_some(TriangleMesh& mesh, double share, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> turned(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (random() < share * 4294967296.0) {
            turn(mesh.faces[f]);
            turned[f] = 1;
        }
    return turned;
}

std::vector<std::uint8_t> opposite(std::vector<std::uint8_t> turned) {
    for (std::uint8_t& t : turned) t ^= 1;
    return turned;
}

TEST(Winding, AMeshThatAgreesStaysAsItIs) {
    EXPECT_TRUE(faces_to_turn(wound_ball()).empty());
    EXPECT_TRUE(faces_to_turn(wound_ball({0, 0, 0}, 4)).empty());
    TriangleMesh inwards = wound_ball();
    for (auto& face : inwards.faces) turn(face);
    EXPECT_TRUE(faces_to_turn(inwards).empty());
    TriangleMesh soup = wound_ball();  // each face with vertices of its own
    turn_some(soup, 0.5, 1);
    std::vector<glm::vec3> positions;
    for (auto& face : soup.faces)
        for (std::uint32_t& v : face) {
            positions.push_back(soup.positions[v]);
            v = static_cast<std::uint32_t>(positions.size() - 1);
        }
    soup.positions = positions;
    EXPECT_TRUE(faces_to_turn(soup).empty());
}

TEST(Winding, FacesOfAClosedMeshPointOutwards) {
    for (const double share : {0.01, 0.3, 0.5, 0.9, 0.99}) {
        TriangleMesh mesh = wound_ball({100, 50, 3});
        const auto turned = turn_some(mesh, share, 3);
        EXPECT_EQ(faces_to_turn(mesh), turned) << share;
    }
}

TEST(Winding, MostFacesOfAnOpenMeshStayAsTheyAre) {
    for (const double share : {0.02, 0.3, 0.7, 0.98}) {
        TriangleMesh mesh = wound_ball({0, 0, 0}, 3);
        const auto turned = turn_some(mesh, share, 5);
        EXPECT_EQ(faces_to_turn(mesh), share < 0.5 ? turned : opposite(turned)) << share;
    }
}

TEST(Winding, PartsAreJudgedByThemselves) {
    TriangleMesh mesh = wound_ball(), other = wound_ball({5, 0, 0});
    auto turned = turn_some(mesh, 0.7, 7);
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    for (auto face : other.faces) {  // consistent, inwards: kept
        turn(face);
        for (std::uint32_t& v : face) v += vertices;
        mesh.faces.push_back(face);
    }
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    turned.resize(mesh.faces.size());
    EXPECT_EQ(faces_to_turn(mesh), turned);
}

// The same face twice is no neighbour of itself: one of both turned would cancel the other.
TEST(Winding, FacesListedTwiceAreNotTurned) {
    TriangleMesh mesh = wound_ball({0, 0, 0}, 5);
    const auto faces = mesh.faces;
    mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
    EXPECT_TRUE(faces_to_turn(mesh).empty());
}

TEST(Winding, OddMeshesDoNoHarm) {
    const auto strip = [](std::vector<std::array<std::uint32_t, 3>> faces) {
        return TriangleMesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 1}},
                            .faces = std::move(faces),
                            .normals = {},
                            .normal_faces = {}};
    };
    EXPECT_TRUE(faces_to_turn(strip({{0, 0, 0}, {1, 1, 2}, {0, 1, 2}})).empty());
    EXPECT_TRUE(faces_to_turn(strip({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}})).empty());  // an edge of three
    const TriangleMesh moebius = strip({{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}});
    const auto turned = faces_to_turn(moebius);
    EXPECT_LE(std::ranges::count(turned, 1), 2);
}

// Many faces around one vertex take no longer than as many elsewhere.
TEST(Winding, AFanOfManyFacesIsReadInNoTime) {
    TriangleMesh fan;
    constexpr std::uint32_t count = 100'000;
    fan.positions.assign(count + 1, glm::vec3(0));
    for (std::uint32_t i = 1; i < count; ++i) fan.faces.push_back({0, i, i + 1});
    turn(fan.faces[count / 3]);
    const auto turned = faces_to_turn(fan);
    EXPECT_EQ(std::ranges::count(turned, 1), 1);
    EXPECT_EQ(turned[count / 3], 1);
}

TEST(MeshPlacement, SmoothNormalsAreThoseOfTheMeshWoundAlike) {
    TriangleMesh mesh = wound_ball();
    const auto expected = corner_normals(mesh);
    const auto turned = turn_some(mesh, 0.4, 11);
    const auto normals = corner_normals(mesh);
    for (std::size_t f = 0; f < normals.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t other = turned[f] != 0 && corner > 0 ? 3 - corner : corner;
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(normals[f].n[3 * corner + axis], expected[f].n[3 * other + axis], 1e-6);
        }
}

// The file's own normals are not asked for sides; the faces' are where one is missing.
TEST(MeshPlacement, OwnNormalsStayAsTheyAre) {
    TriangleMesh mesh = wound_ball();
    turn_some(mesh, 0.4, 11);
    mesh.normals = mesh.positions;
    for (const auto& face : mesh.faces)
        mesh.normal_faces.push_back({static_cast<int>(face[0]), static_cast<int>(face[1]), static_cast<int>(face[2])});
    const auto normals = corner_normals(mesh);
    for (std::size_t f = 0; f < normals.size(); ++f)
        EXPECT_NEAR(normals[f].n[0], mesh.positions[mesh.faces[f][0]].x, 1e-6);
}

}  // namespace
}  // namespace raywalk
