// What ships: every scene reads without a warning and finds its files; what is generated is what it is said to be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <variant>
#include <vector>

#include "scenes/generate/ball_field.h"
#include "scenes/generate/sculpture.h"
#include "scenes/generate/teapot.h"
#include "scenes/generate/textures.h"
#include "tracer/files/mesh/obj_reader.h"
#include "tracer/files/scene_text/parser.h"

namespace {

namespace fs = std::filesystem;
using namespace raywalk;

std::vector<fs::path> shipped_scenes() {
    std::vector<fs::path> scenes;
    for (const auto& entry : fs::directory_iterator(fs::path(RAYWALK_ROOT) / "scenes"))
        if (entry.path().extension() == ".scene") scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

class ShippedScene : public testing::TestWithParam<fs::path> {};

TEST_P(ShippedScene, ReadsWithoutAWarningAndFindsItsFiles) {
    std::vector<Diagnostic> warnings;
    const Scene scene = read_scene(GetParam(), Limits{}, warnings);
    for (const Diagnostic& warning : warnings) ADD_FAILURE() << to_string(warning);
    EXPECT_FALSE(scene.lights.empty());
    for (const Mesh& mesh : scene.meshes) EXPECT_TRUE(fs::is_regular_file(mesh.file)) << mesh.file;
    const auto expect_image = [](const Texture& texture) {
        if (const auto* image = std::get_if<ImageTexture>(&texture.pattern)) {
            EXPECT_TRUE(fs::is_regular_file(image->file)) << image->file;
        }
    };
    for (const Plane& plane : scene.planes) expect_image(plane.texture);
    for (const Sphere& sphere : scene.spheres) expect_image(sphere.texture);
}

INSTANTIATE_TEST_SUITE_P(Every, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });

// Six times the signed volume between the surface and the origin, of a closed mesh.
double volume(const generate::Mesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces)
        sum += glm::dot(glm::dvec3(mesh.positions[a]),
                        glm::cross(glm::dvec3(mesh.positions[b]), glm::dvec3(mesh.positions[c])));
    return sum / 6;
}

TEST(GeneratedMesh, TheSculptureIsClosedAndOfMoreThanAHundredThousandTriangles) {
    const generate::Mesh mesh = generate::saddle_ring(1);
    const generate::Edges edges = generate::count_edges(mesh);
    EXPECT_EQ(edges.open, 0u);
    EXPECT_EQ(edges.crowded, 0u);
    EXPECT_GT(mesh.faces.size(), 100'000u);
    EXPECT_GT(volume(mesh), 0) << "faces run clockwise";
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    std::size_t against = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const glm::vec3 face = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        against += glm::dot(face, mesh.normals[a]) <= 0;
    }
    EXPECT_LE(against, mesh.faces.size() / 10'000) << "normals point inwards";
    // vertices - edges + faces = 2 - 2 holes
    const auto faces = static_cast<long>(mesh.faces.size()), vertices = static_cast<long>(mesh.positions.size());
    EXPECT_LT(vertices - faces * 3 / 2 + faces, 0) << "a ring of saddles has holes";
}

TEST(GeneratedMesh, TheTeapotIsOpenOnlyWhereNewellLeftIt) {
    const generate::Mesh mesh = generate::teapot(8);
    const generate::Edges edges = generate::count_edges(mesh);
    EXPECT_EQ(edges.crowded, 0u);
    EXPECT_EQ(edges.boundary_loops, 6u) << "lid, rim, spout's mouth and foot, both ends of the handle";
    float lowest = 1e9f, highest = -1e9f;
    for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, p.y), highest = std::max(highest, p.y);
    EXPECT_NEAR(lowest, 0, 1e-6);
    EXPECT_NEAR(highest, 3.15, 1e-6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-5) << i;
}

TEST(GeneratedMesh, ReadsBackAsItWasWritten) {
    const generate::Mesh mesh = generate::trefoil_knot(30, 8);
    std::vector<Diagnostic> warnings;
    const TriangleMesh read = parse_obj(generate::obj_text(mesh, "knot"), "knot.obj", Limits{}, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(read.faces, mesh.faces);
    ASSERT_EQ(read.positions.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_LT(glm::distance(read.positions[i], mesh.positions[i]), 2e-5f);
}

TEST(GeneratedScene, TheBallFieldHasAsManyBallsAsAskedFor) {
    std::vector<Diagnostic> warnings;
    const Scene scene = parse_scene(generate::ball_field_scene(10'000), fs::path(RAYWALK_ROOT) / "scenes/field.scene",
                                    Limits{}, warnings);
    EXPECT_EQ(scene.spheres.size(), 10'000u);
    EXPECT_EQ(scene.planes.size(), 2u);
    EXPECT_TRUE(warnings.empty());
}

// Mean step in brightness from the pixels of one column (row) to those of another.
double step_between(const generate::Picture& picture, int from, int to, bool columns) {
    double sum = 0;
    for (int i = 0; i < picture.side; ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const auto at = [&](int line) {
                const int row = columns ? i : line, column = columns ? line : i;
                return int{picture.rgb[(static_cast<std::size_t>(row) * picture.side + column) * 3 + channel]};
            };
            sum += std::abs(at(from) - at(to));
        }
    return sum / (3.0 * picture.side);
}

class GeneratedTexture : public testing::TestWithParam<const char*> {};

TEST_P(GeneratedTexture, HasNoSeamWhereItRepeats) {
    const generate::Picture picture = generate::texture(GetParam(), 256);
    for (const bool columns : {true, false}) {
        double largest = 0;
        for (int line = 0; line + 1 < picture.side; ++line)
            largest = std::max(largest, step_between(picture, line, line + 1, columns));
        EXPECT_LE(step_between(picture, picture.side - 1, 0, columns), largest);
    }
}

TEST_P(GeneratedTexture, IsAPictureAndNoPlainColour) {
    const generate::Picture picture = generate::texture(GetParam(), 128);
    double sum = 0, squares = 0;
    for (const std::uint8_t value : picture.rgb) sum += value, squares += value * value;
    const double mean = sum / picture.rgb.size();
    EXPECT_GT(mean, 40);
    EXPECT_GT(std::sqrt(squares / picture.rgb.size() - mean * mean), 5);
}

INSTANTIATE_TEST_SUITE_P(Every, GeneratedTexture, testing::Values("brick", "stone", "wood", "tiles", "marble"),
                         [](const auto& texture) { return std::string(texture.param); });

}  // namespace
