#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/support/process.h"
#include "tracer/compiled/compile.h"
#include "tracer/compiled/local_origin.h"
#include "tracer/files/image/image.h"
#include "tracer/files/load.h"

namespace raywalk {
namespace {

using test::TemporaryFolder;
using test::write_file;
using testing::HasSubstr;

Texture pure(const glm::dvec3& color) { return {.material = materials[4], .pattern = PureTexture{color}}; }

Mesh mesh_of(const std::filesystem::path& file, bool smooth) {
    return {.texture = pure({1, 1, 0}),
            .file = file,
            .where = {.file = "test.scene", .line = 7, .column = 6},
            .center = {0, 0, 0},
            .radius = 2,
            .smooth = smooth};
}

constexpr const char* tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

CompiledScene compiled(const Scene& scene, std::vector<Diagnostic>* warnings = nullptr, const Limits& limits = {}) {
    std::vector<Diagnostic> ignored;
    return compile(scene, load_assets(scene, limits, warnings != nullptr ? *warnings : ignored), {});
}

std::vector<Diagnostic> errors_of(const Scene& scene, const Limits& limits = {}) {
    try {
        compiled(scene, nullptr, limits);
    } catch (const InputError& error) {
        return error.diagnostics();
    }
    return {};
}

TEST(Compile, SmoothTrianglesComeFirstThenFlatMeshesThenFaces) {
    const TemporaryFolder folder;
    write_file(folder.path() / "t.obj", tetrahedron);
    Scene scene;
    scene.faces.push_back({.texture = pure({1, 0, 0}), .a = {0, 0, 0}, .b = {1, 0, 0}, .c = {0, 1, 0}});
    scene.meshes.push_back(mesh_of(folder.path() / "t.obj", false));
    scene.meshes.push_back(mesh_of(folder.path() / "t.obj", true));
    const CompiledScene result = compiled(scene);
    EXPECT_EQ(result.triangle_count, 9);
    EXPECT_EQ(result.smooth_count, 4);
    EXPECT_EQ(result.vertex_normals.size(), 4u);
    ASSERT_EQ(result.triangles.size(), 9u);
    const TriangleRecord& face = result.triangles[8];
    EXPECT_EQ(face.normal[2], 1);
    EXPECT_EQ(result.surfaces[static_cast<std::size_t>(face.surface)].color[1], 0);
    EXPECT_EQ(result.surfaces[static_cast<std::size_t>(result.triangles[0].surface)].color[1], 1);
}

TEST(Compile, AMeshNamedTwiceIsReadOnce) {
    const TemporaryFolder folder;
    write_file(folder.path() / "t.obj", tetrahedron);
    Scene scene;
    scene.meshes = {mesh_of(folder.path() / "t.obj", false), mesh_of(folder.path() / "t.obj", true)};
    MemoryBudget memory({});
    EXPECT_EQ(read_meshes(scene, {}, memory).files.size(), 1u);
}

TEST(Compile, ShapesThatLookTheSameShareASurface) {
    Scene scene;
    for (int i = 0; i < 100; ++i)
        scene.spheres.push_back({.texture = pure({0, 0, i % 2 == 0 ? 1.0 : 0.5}),
                                 .center = {i, 0, 0},
                                 .radius = 0.5,
                                 .refraction_index = 1.5});
    scene.planes.push_back({.texture = {.material = materials[0], .pattern = GridTexture{.density = 2}},
                            .normal = {0, 1, 0},
                            .offset = -1});
    const CompiledScene result = compiled(scene);
    EXPECT_EQ(result.sphere_count, 100);
    EXPECT_EQ(result.plane_count, 1);
    EXPECT_EQ(result.surfaces.size(), 3u);
    EXPECT_EQ(result.spheres[0].surface, result.spheres[98].surface);
    EXPECT_NE(result.spheres[0].surface, result.spheres[1].surface);
    EXPECT_EQ(result.spheres[3].center[0], 3);
    EXPECT_EQ(result.spheres[3].refraction_index, 1.5f);
    const SurfaceRecord& grid = result.surfaces[static_cast<std::size_t>(result.planes[0].surface)];
    EXPECT_EQ(grid.pattern, Pattern::grid);
    EXPECT_EQ(grid.scale, 2);
    EXPECT_EQ(grid.specular, 0.1f);
    EXPECT_EQ(grid.shininess, 5);
    EXPECT_EQ(result.planes[0].offset, -1);
}

// The axes for a normal, before and after they are put into single precision.
std::pair<glm::vec3, glm::vec3> axes(const glm::dvec3& normal) {
    Scene scene;
    scene.planes.push_back({.texture = pure({1, 1, 1}), .normal = glm::normalize(normal), .offset = 0});
    const PlaneRecord record = compiled(scene).planes[0];
    return {{record.u_axis[0], record.u_axis[1], record.u_axis[2]},
            {record.v_axis[0], record.v_axis[1], record.v_axis[2]}};
}

TEST(Compile, PlaneAxesOfAxisAlignedNormalsAreExact) {
    using P = std::pair<glm::vec3, glm::vec3>;
    EXPECT_EQ(axes({0, 1, 0}), P({-1, 0, 0}, {0, 0, 1}));
    EXPECT_EQ(axes({0, -1, 0}), P({1, 0, 0}, {0, 0, -1}));
    EXPECT_EQ(axes({1, 0, 0}), P({0, 1, 0}, {0, 0, 1}));
    EXPECT_EQ(axes({-1, 0, 0}), P({0, -1, 0}, {0, 0, -1}));
    EXPECT_EQ(axes({0, 0, 1}), P({-1, 0, 0}, {0, -1, 0}));
    EXPECT_EQ(axes({0, 0, -1}), P({1, 0, 0}, {0, 1, 0}));
}

TEST(Compile, PlaneAxesOfOtherNormalsAreOrthonormalAndContinueThose) {
    for (const glm::dvec3 normal : {glm::dvec3(1, 2, 3), {-3, 1, 0.5}, {0.1, -5, 0.2}, {1, 1, 1}, {0, 1, 1e-9}}) {
        const auto [u, v] = axes(normal);
        const glm::vec3 n(glm::normalize(normal));
        EXPECT_NEAR(glm::length(u), 1, 1e-6);
        EXPECT_NEAR(glm::length(v), 1, 1e-6);
        EXPECT_NEAR(glm::dot(u, v), 0, 1e-6);
        EXPECT_NEAR(glm::dot(u, n), 0, 1e-6);
        EXPECT_NEAR(glm::dot(v, n), 0, 1e-6);
    }
    for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}})
        for (const glm::dvec3 nudge : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}, {1, -1, 1}}) {
            const auto [u, v] = axes(axis);
            const auto [near_u, near_v] = axes(axis + 1e-4 * nudge);
            EXPECT_LT(glm::length(u - near_u), 3e-4);
            EXPECT_LT(glm::length(v - near_v), 3e-4);
        }
}

TEST(Compile, AnAreaLightIsNTimesNPointsOfItsIntensity) {
    Scene scene;
    scene.lights.push_back({.origin = {0, 0, 0}, .color = {1, 1, 1}, .intensity = 0.25, .area = {}});
    scene.lights.push_back(
        {.origin = {1, 2, 3}, .color = {1, 0, 1}, .intensity = 8, .area = AreaSpread{.n = 4, .radius = 0.5}});
    const CompiledScene result = compiled(scene);
    ASSERT_EQ(result.light_groups.size(), 2u);
    ASSERT_EQ(result.light_points.size(), 17u);
    EXPECT_EQ(result.light_points[0].position[0], 0);
    EXPECT_EQ(result.light_points[0].radiance[2], 0.25f);
    EXPECT_EQ(result.light_groups[1].first, 1u);
    EXPECT_EQ(result.light_groups[1].count, 16u);
    const auto expect_point = [&](std::size_t i, std::size_t j, const glm::vec3& offset) {
        const LightPoint& point = result.light_points[1 + 4 * i + j];
        EXPECT_LT(glm::length(glm::vec3(point.position[0], point.position[1], point.position[2]) - glm::vec3(1, 2, 3) -
                              0.5f * offset),
                  1e-6)
            << i << " " << j;
        EXPECT_EQ(point.radiance[0], 0.5f);
        EXPECT_EQ(point.radiance[1], 0);
    };
    expect_point(0, 0, {0, 1, 0});  // a = 0, b = 0
    expect_point(1, 0, {1, 0, 0});  // a = 90 degrees
    expect_point(0, 1, {0, 0, 1});  // b = 90 degrees
    expect_point(2, 2, {0, 1, 0});  // both 180 degrees
}

TEST(Compile, AnEmptySceneIsCompiledWithNothingForGathersToMiss) {
    const CompiledScene result = compiled({});
    EXPECT_FALSE(result.surfaces.empty());
    EXPECT_FALSE(result.images.empty());
    EXPECT_FALSE(result.texels.empty());
    EXPECT_EQ(result.triangle_count + result.sphere_count + result.plane_count, 0);
}

// A plain PPM is not among the formats that scenes may read, so test pictures are written by the library itself.
void write_picture(const std::filesystem::path& file, int width, int height, std::uint8_t red) {
    std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width * height) * 3, 0);
    for (std::size_t i = 0; i < rgb.size(); i += 3) rgb[i] = red;
    write_image(file, width, height, rgb);
}

Sphere textured(const std::filesystem::path& file) {
    return {
        .texture = {.material = materials[0],
                    .pattern =
                        ImageTexture{.file = file, .size = 4, .where = {.file = "test.scene", .line = 3, .column = 9}}},
        .center = {0, 0, 0},
        .radius = 1,
        .refraction_index = 1};
}

TEST(Compile, ImagesStandOneAfterTheOtherAndEachIsReadOnce) {
    const TemporaryFolder folder;
    write_picture(folder.path() / "b.png", 2, 2, 200);
    write_picture(folder.path() / "a.png", 4, 4, 100);
    Scene scene;
    for (const char* name : {"b.png", "a.png", "b.png"}) scene.spheres.push_back(textured(folder.path() / name));
    std::vector<Diagnostic> warnings;
    const CompiledScene result = compiled(scene, &warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(result.images.size(), 2u);
    EXPECT_EQ(result.texels.size(), 20u);
    EXPECT_EQ(result.surfaces.size(), 2u);
    for (int i = 0; i < 3; ++i) {
        const SurfaceRecord& surface =
            result.surfaces[static_cast<std::size_t>(result.spheres[static_cast<std::size_t>(i)].surface)];
        const ImageRecord& image = result.images[static_cast<std::size_t>(surface.image)];
        EXPECT_EQ(surface.pattern, Pattern::image);
        EXPECT_EQ(surface.scale, 0.25f);
        EXPECT_EQ(image.width, i == 1 ? 4 : 2);
        EXPECT_EQ(result.texels[image.first_texel] & 0xFF, i == 1 ? 100u : 200u);
    }
}

TEST(Compile, AnImageThatIsNotSquareIsStretchedWithOneWarning) {
    const TemporaryFolder folder;
    write_picture(folder.path() / "wide.png", 8, 2, 1);
    Scene scene;
    for (int i = 0; i < 3; ++i) scene.spheres.push_back(textured(folder.path() / "wide.png"));
    std::vector<Diagnostic> warnings;
    compiled(scene, &warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].severity, Severity::warning);
    EXPECT_EQ(warnings[0].where.line, 3u);
    EXPECT_THAT(warnings[0].what, HasSubstr("8 x 2 pixels and is stretched"));
}

TEST(Compile, EveryWrongFileIsReportedAtItsPlace) {
    const TemporaryFolder folder;
    write_file(folder.path() / "points.obj", "v 0 0 0\nv 1 1 1\n");
    write_file(folder.path() / "dot.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    write_file(folder.path() / "noise.png", "this is no picture");
    Scene scene;
    for (const char* name : {"points.obj", "dot.obj", "points.obj"})
        scene.meshes.push_back(mesh_of(folder.path() / name, true));
    scene.spheres.push_back(textured(folder.path() / "noise.png"));
    const std::vector<Diagnostic> errors = errors_of(scene);
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_THAT(errors[0].what, HasSubstr("face"));
    EXPECT_THAT(errors[1].what, HasSubstr("all its vertices are one point"));
    EXPECT_EQ(errors[1].where.line, 7u);
    EXPECT_EQ(errors[2].where.line, 3u);
}

TEST(Compile, BudgetsCountTheWholeScene) {
    const TemporaryFolder folder;
    write_file(folder.path() / "t.obj", tetrahedron);
    Scene scene;
    for (int i = 0; i < 3; ++i) scene.meshes.push_back(mesh_of(folder.path() / "t.obj", true));
    Limits limits;
    limits.triangles = 12;
    EXPECT_TRUE(errors_of(scene, limits).empty());
    limits.triangles = 11;
    const std::vector<Diagnostic> errors = errors_of(scene, limits);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_THAT(errors[0].what, HasSubstr("the scene has 12 triangles"));
    EXPECT_THAT(errors[0].expected, HasSubstr("--max-triangles"));

    const std::filesystem::path images[] = {folder.path() / "a.png", folder.path() / "b.png", folder.path() / "c.png"};
    Scene textured;
    for (const std::filesystem::path& image : images) {
        write_image(image, 4, 4, std::vector<std::uint8_t>(48));
        textured.planes.push_back({.texture = {.pattern = ImageTexture{.file = image}}, .normal = {0, 1, 0}});
    }
    limits.all_image_pixels = 48;
    EXPECT_TRUE(errors_of(textured, limits).empty());
    limits.all_image_pixels = 31;
    const std::vector<Diagnostic> image_errors = errors_of(textured, limits);
    ASSERT_EQ(image_errors.size(), 1u);
    EXPECT_THAT(image_errors[0].expected, HasSubstr("--max-all-image-pixels"));
}

TEST(Compile, ShapesTooSmallForTheirPlaceAreWarnedOf) {
    Scene scene;
    scene.file = "test.scene";
    const auto add = [&](double x, double radius) {
        scene.spheres.push_back(
            {.texture = pure({1, 0, 0}), .center = {x, 0, 0}, .radius = radius, .refraction_index = 1});
    };
    add(0, 1);
    add(1000, 1);
    EXPECT_TRUE(small_shape_warnings(scene).empty());
    add(1e6, 0.9);  // 2^-20 of a million is 0.95
    ASSERT_EQ(small_shape_warnings(scene).size(), 1u);
    EXPECT_THAT(small_shape_warnings(scene)[0].what, HasSubstr("1 shape is smaller than a millionth"));
    add(1e6, 2);
    EXPECT_THAT(small_shape_warnings(scene)[0].what, HasSubstr("1 shape is"));
}

}  // namespace
}  // namespace raywalk
