#include "tracer/compiled/mesh_placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace raywalk {
namespace {

// Two triangles over the unit square: one in the plane z = 0, the other folded up along the diagonal.
TriangleMesh folded_square() {
    return {.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}},
            .faces = {{0, 1, 2}, {0, 2, 3}},
            .normals = {},
            .normal_faces = {}};
}

glm::vec3 normal_at(const VertexNormals& normals, int corner) {
    return {normals.n[3 * corner], normals.n[3 * corner + 1], normals.n[3 * corner + 2]};
}

TEST(MeshPlacement, TheVertexMeanGoesToTheCenterAndTheFarthestVertexToTheRadius) {
    const TriangleMesh mesh = folded_square();
    const glm::dvec3 center(10, -20, 30);
    const auto placed = placed_positions(mesh, center, 4);
    glm::dvec3 mean(0);
    double farthest = 0;
    for (const glm::vec3& p : placed) {
        mean += glm::dvec3(p) / 4.0;
        farthest = std::max(farthest, glm::length(glm::dvec3(p) - center));
    }
    EXPECT_LT(glm::length(mean - center), 1e-6);
    EXPECT_NEAR(farthest, 4, 1e-5);
}

TEST(MeshPlacement, ShapesKeepTheirProportions) {
    const auto placed = placed_positions(folded_square(), {0, 0, 0}, 7);
    EXPECT_NEAR(glm::length(placed[1] - placed[0]) / glm::length(placed[2] - placed[1]), 1, 1e-6);
    EXPECT_NEAR(glm::length(placed[2] - placed[0]) / glm::length(placed[1] - placed[0]), std::sqrt(2.0), 1e-6);
}

TEST(MeshPlacement, MeshesFarAwayOrTinyOrHugeArePlacedTheSame) {
    const auto expected = placed_positions(folded_square(), {1, 2, 3}, 4);
    for (const float scale : {1e-30f, 1e30f}) {
        TriangleMesh mesh = folded_square();
        for (glm::vec3& p : mesh.positions) p *= scale;
        const auto placed = placed_positions(mesh, {1, 2, 3}, 4);
        for (std::size_t i = 0; i < placed.size(); ++i) EXPECT_LT(glm::length(placed[i] - expected[i]), 1e-5);
        const VertexNormals normals = corner_normals(mesh)[0];
        EXPECT_NEAR(glm::length(normal_at(normals, 0)), 1, 1e-6);
    }
}

TEST(MeshPlacement, PlacesNothingBeyondTheCoordinateLimit) {
    for (const glm::vec3& p : placed_positions(folded_square(), {1e30, 0, 0}, 1e20))
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(p[axis]), 1.0001e12f);
}

TEST(MeshPlacement, SaysWhyAMeshCannotBePlaced) {
    EXPECT_EQ(placement_problem(folded_square()), "");
    EXPECT_NE(placement_problem({}), "");
    TriangleMesh no_faces = folded_square();
    no_faces.faces.clear();
    EXPECT_NE(placement_problem(no_faces), "");
    TriangleMesh point = folded_square();
    for (glm::vec3& p : point.positions) p = {1, 2, 3};
    EXPECT_NE(placement_problem(point), "");
}

TEST(MeshPlacement, NormalsAreTheUnweightedMeanOfTheFacesAround) {
    const auto normals = corner_normals(folded_square());
    const glm::vec3 first(0, 0, 1), second = glm::normalize(glm::cross(glm::vec3(1, 1, 0), glm::vec3(0, 1, 1)));
    const glm::vec3 mean = glm::normalize(first + second);
    EXPECT_LT(glm::length(normal_at(normals[0], 0) - mean), 1e-6);   // shared
    EXPECT_LT(glm::length(normal_at(normals[0], 1) - first), 1e-6);  // of the first face alone
    EXPECT_LT(glm::length(normal_at(normals[0], 2) - mean), 1e-6);
    EXPECT_LT(glm::length(normal_at(normals[1], 2) - second), 1e-6);
}

TEST(MeshPlacement, AreasDoNotWeighNormals) {
    TriangleMesh mesh = folded_square();
    mesh.positions[3] = {0, 100, 100};  // a far larger second face in the same direction as before
    TriangleMesh small = folded_square();
    small.positions[3] = {0, 0.01f, 0.01f};
    const glm::vec3 second_large = geometric_normal(mesh.positions[0], mesh.positions[2], mesh.positions[3]);
    const glm::vec3 second_small = geometric_normal(small.positions[0], small.positions[2], small.positions[3]);
    ASSERT_LT(glm::length(second_large - second_small), 1e-5);
    EXPECT_LT(glm::length(normal_at(corner_normals(mesh)[0], 0) - normal_at(corner_normals(small)[0], 0)), 1e-5);
}

TEST(MeshPlacement, TheFilesOwnNormalsWinAndAreMadeUnitLength) {
    TriangleMesh mesh = folded_square();
    mesh.normals = {{0, 5, 0}, {0, 0, 0}};
    mesh.normal_faces = {{0, -1, 1}, {-1, -1, 0}};
    const auto own = corner_normals(mesh), mean = corner_normals(folded_square());
    EXPECT_EQ(normal_at(own[0], 0), glm::vec3(0, 1, 0));
    EXPECT_EQ(normal_at(own[0], 1), normal_at(mean[0], 1));  // -1: the mean
    EXPECT_EQ(normal_at(own[0], 2), normal_at(mean[0], 2));  // a zero normal: the mean
    EXPECT_EQ(normal_at(own[1], 2), glm::vec3(0, 1, 0));
}

TEST(MeshPlacement, NormalsThatCancelFallBackToTheFace) {
    // The same triangle twice, back to back.
    const TriangleMesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                            .faces = {{0, 1, 2}, {0, 2, 1}},
                            .normals = {},
                            .normal_faces = {}};
    const auto normals = corner_normals(mesh);
    EXPECT_EQ(normal_at(normals[0], 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal_at(normals[1], 0), glm::vec3(0, 0, -1));
}

TEST(MeshPlacement, TrianglesWithoutAreaHaveAUnitNormalAndWeighNothing) {
    TriangleMesh mesh = folded_square();
    mesh.faces.push_back({0, 0, 1});
    mesh.faces.push_back({1, 1, 1});
    const auto normals = corner_normals(mesh), without = corner_normals(folded_square());
    EXPECT_EQ(normal_at(normals[0], 0), normal_at(without[0], 0));
    for (const VertexNormals& normal : normals)
        for (int corner = 0; corner < 3; ++corner) EXPECT_NEAR(glm::length(normal_at(normal, corner)), 1, 1e-6);
    EXPECT_NEAR(glm::length(geometric_normal(glm::vec3(1), glm::vec3(1), glm::vec3(1))), 1, 1e-6);
}

}  // namespace
}  // namespace raywalk
