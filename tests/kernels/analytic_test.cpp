// Pictures whose pixels are known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/kernels/scene.h"

namespace raywalk {
namespace {

constexpr double pi = std::numbers::pi;

// The one pixel of a picture whose only ray runs along -z from the origin.
glm::vec3 middle_ray(Scene scene, const PictureOptions& options = {}) {
    scene.viewer = viewer_along_z(1, 1, 1);
    return picture_of(scene, options).at(0, 0);
}

Plane wall(double z, const Texture& texture) { return {.texture = texture, .normal = {0, 0, 1}, .offset = z}; }

void expect_near(const glm::vec3& value, const glm::dvec3& expected, double tolerance) {
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(value[channel], expected[channel], tolerance) << channel;
}

TEST(Shading, SphereCoversThePixelsOfItsSilhouetteAndNoOther) {
    Scene scene;
    scene.viewer = viewer_along_z(161, 120, 40);
    const glm::dvec3 center(0.7, -0.4, -9);
    scene.spheres.push_back({.texture = surface({1, 1, 1}, materials[4]), .center = center, .radius = 2});
    const Picture picture = picture_of(scene);
    const Camera camera = opening_camera(scene.viewer, 161.0 / 120);
    const double edge = std::asin(2 / glm::length(center));
    int inside = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 161; ++x) {
            const glm::dvec3 d = direction_through(camera, 161, 120, x + 0.5, y + 0.5);
            const double angle = std::acos(glm::dot(d, glm::normalize(center)));
            if (std::abs(angle - edge) < 1e-6) continue;
            EXPECT_EQ(picture.at(x, y).x > 0, angle < edge) << x << ", " << y;
            inside += angle < edge;
        }
    EXPECT_GT(inside, 1000);
}

TEST(Shading, LightFadesByTheLengthOfItsWholePath) {
    for (const double distance : {0.5, 10.0, 80.0}) {
        Scene scene;
        scene.planes.push_back(wall(-distance, surface({1, 0.5, 0.25}, matte)));
        scene.lights.push_back(white_light({0, 0, 3}, 2));
        const double kept = std::exp(-mu * (distance + distance + 3));
        expect_near(middle_ray(scene), glm::dvec3(2, 1, 0.5) * kept, 1e-6);
    }
}

TEST(Shading, PathLengthAddsUpOverMirrors) {
    Scene scene;
    scene.planes.push_back(wall(-4, surface({0, 0, 0}, perfect_mirror)));
    scene.planes.push_back(wall(6, surface({1, 1, 1}, matte)));  // behind the eye
    scene.lights.push_back(white_light({0, 0, 1}));
    const double kept = std::exp(-mu * (4 + 10 + 5));
    expect_near(middle_ray(scene), glm::dvec3(kept), 1e-6);
}

TEST(Shading, PhongAtAKnownAngle) {
    for (const int shininess : {0, 1, 5, 20})
        for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
            const double angle = degrees * pi / 180, distance = 10, light_distance = 3;
            Scene scene;
            scene.planes.push_back(wall(-distance, surface({0.8, 0.4, 0.2}, {"test", 0.5, 0.3, shininess, 0, 0})));
            scene.lights.push_back(white_light(
                glm::dvec3(std::sin(angle), 0, std::cos(angle)) * light_distance + glm::dvec3(0, 0, -distance), 1.5));
            const double kept = 1.5 * std::exp(-mu * (distance + light_distance));
            const glm::dvec3 expected = glm::dvec3(0.2 * 0.5) + kept * glm::dvec3(0.8, 0.4, 0.2) * std::cos(angle) +
                                        kept * 0.3 * std::pow(std::cos(angle), shininess);
            expect_near(middle_ray(scene), expected, 2e-6);
        }
}

TEST(Shading, NothingBetweenIsTransparentToLight) {
    Scene scene;
    scene.planes.push_back(wall(-10, surface({1, 1, 1}, matte)));
    scene.lights.push_back(white_light({0, 5, -5}));
    EXPECT_GT(middle_ray(scene).x, 0.1f);
    scene.spheres.push_back({.texture = surface({0, 0, 0}, see_through), .center = {0, 2.5, -7.5}, .radius = 0.5});
    EXPECT_EQ(middle_ray(scene).x, 0.0f);
}

// Two parallel perfect mirrors that glow a little: the camera ray and five reflections are seen, no more.
TEST(Shading, DepthIsLimitedToFive) {
    Scene scene;
    const Material glowing = {"glowing", 1, 0, 0, 1, 0};
    scene.planes.push_back(wall(-4, surface({0, 0, 0}, glowing)));
    scene.planes.push_back(wall(6, surface({0, 0, 0}, glowing)));
    expect_near(middle_ray(scene), glm::dvec3(6 * 0.2), 1e-6);
}

// Both ways at every hit, the weights multiplied: 2^depth rays.
TEST(Shading, MirrorAndGlassAtOnceMakeBothRays) {
    Scene scene;
    const Material both = {"both", 1, 0, 0, 0.5, 0.25};
    scene.planes.push_back(wall(-4, surface({0, 0, 0}, both)));
    // The mirrored ray leaves the scene, the straight one meets the next wall; each wall sees what passed the others.
    for (int i = 1; i < 3; ++i) scene.planes.push_back(wall(-4 - i, surface({0, 0, 0}, {"glow", 1, 0, 0, 0, 0.25})));
    expect_near(middle_ray(scene), glm::dvec3(0.2 * (1 + 0.25 + 0.0625)), 1e-6);

    Scene box;  // every wall of a box mirrors and lets through: hits = 1 + 1 (mirrored) per level, outside nothing
    box.planes.push_back(wall(-4, surface({0, 0, 0}, both)));
    box.planes.push_back(wall(4, surface({0, 0, 0}, both)));
    double expected = 0;
    for (int depth = 0; depth <= 5; ++depth) expected += 0.2 * std::pow(0.5, depth);
    expect_near(middle_ray(box), glm::dvec3(expected), 1e-6);
}

// What a mirror shows is what stands behind it, mirrored: object, light and all.
void expect_virtual_image(const Scene& with_mirror, const Scene& behind_mirror) {
    const Picture mirrored = picture_of(with_mirror), direct = picture_of(behind_mirror);
    EXPECT_GT(std::ranges::count_if(direct.pixels, [](const glm::vec3& p) { return p.x > 0.01f; }), 300);
    EXPECT_LE(share_of_differing(mirrored, direct, 2e-5), 0.002);
}

TEST(Shading, MirrorShowsTheVirtualImage) {
    Scene mirrored, direct;
    mirrored.viewer = direct.viewer = viewer_along_z(96, 64, 28);
    const Texture ball = surface({1, 0.5, 0.2}, {"ball", 0.05, 0.2, 5, 0, 0});
    mirrored.lights.push_back(white_light({2, 5, 3}));
    mirrored.spheres.push_back({.texture = ball, .center = {0.5, 0.3, 4}, .radius = 1});
    mirrored.spheres.push_back({.texture = ball, .center = {-1.5, -0.3, 6}, .radius = 1.2});
    direct.lights.push_back(white_light({2, 5, -15}));
    direct.spheres.push_back({.texture = ball, .center = {0.5, 0.3, -16}, .radius = 1});
    direct.spheres.push_back({.texture = ball, .center = {-1.5, -0.3, -18}, .radius = 1.2});
    mirrored.planes.push_back(wall(-6, surface({0, 0, 0}, perfect_mirror)));
    expect_virtual_image(mirrored, direct);

    // The same by two triangles in place of the plane.
    mirrored.planes.pop_back();
    const Texture mirror = surface({0, 0, 0}, perfect_mirror);
    mirrored.faces.push_back({.texture = mirror, .a = {-9, -2, -6}, .b = {9, -2, -6}, .c = {9, 9, -6}});
    mirrored.faces.push_back({.texture = mirror, .a = {-9, -2, -6}, .b = {9, 9, -6}, .c = {-9, 9, -6}});
    expect_virtual_image(mirrored, direct);
}

// In the plane of incidence, x along the ray, the ray at height b: it enters at angle pi - i, leaves at 2 t - i, turned
// by -2 (i - t), with sin i = b / r, sin t = b / (n r).
TEST(Shading, GlassSphereBendsRaysBySnellsLaw) {
    Scene scene;
    scene.viewer = viewer_along_z(120, 120, 24);
    const double radius = 2, index = 1.5, distance = 10, wall_z = -16;
    scene.spheres.push_back({.texture = surface({0, 0, 0}, see_through),
                             .center = {0, 0, -distance},
                             .radius = radius,
                             .refraction_index = index});
    scene.planes.push_back(wall(wall_z, {matte, GridTexture{2}}));
    scene.lights.push_back(white_light({0.1, 0.2, -13.5}));
    const Picture picture = picture_of(scene);
    const Camera camera = opening_camera(scene.viewer, 1);
    int checked = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x) {
            const glm::dvec3 d = direction_through(camera, 120, 120, x + 0.5, y + 0.5), center(0, 0, -distance);
            const glm::dvec3 across = glm::dot(center, d) * d - center;  // from the centre to the ray's nearest point
            const double b = glm::length(across);
            if (b > 0.95 * radius) continue;
            const double i = std::asin(b / radius), t = std::asin(b / (index * radius));
            const glm::dvec3 up = across / b;
            const glm::dvec3 exit = center + radius * (std::cos(2 * t - i) * d + std::sin(2 * t - i) * up);
            const glm::dvec3 out = std::cos(2 * (i - t)) * d - std::sin(2 * (i - t)) * up;
            const glm::dvec3 p = exit + out * ((wall_z - exit.z) / out.z);
            // Spec 4.6: for this normal u and v are -x and -y, up to their order.
            const double u = p.x * 2, v = p.y * 2;
            if (std::abs(u - std::round(u)) < 1e-3 || std::abs(v - std::round(v)) < 1e-3) continue;
            const bool white = std::fmod(std::abs(std::floor(-u) + std::floor(-v)), 2) == 1;
            EXPECT_EQ(picture.at(x, y).x > 1e-3f, white) << x << ", " << y;
            ++checked;
        }
    EXPECT_GT(checked, 5000);
}

// Into a thinner medium beyond the critical angle, sin = n, nothing passes: the sphere is a mirror there.
TEST(Shading, TotalReflectionReflects) {
    Scene bubble;
    bubble.viewer = viewer_along_z(80, 80, 24);
    bubble.planes.push_back({.texture = {matte, GridTexture{1}}, .normal = {0, 1, 0}, .offset = -6});
    bubble.planes.push_back({.texture = surface({1, 0.5, 0.2}, matte), .normal = {1, 0, 0}, .offset = -7});
    bubble.lights.push_back(white_light({3, 5, 2}));
    bubble.spheres.push_back(
        {.texture = surface({0, 0, 0}, see_through), .center = {0, 0, -10}, .radius = 2, .refraction_index = 0.5});
    Scene mirror = bubble;
    mirror.spheres[0].texture = surface({0, 0, 0}, perfect_mirror);
    const Picture a = picture_of(bubble), b = picture_of(mirror);
    const Camera camera = opening_camera(bubble.viewer, 1);
    int total = 0, differing = 0;
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x) {
            const double sine =
                glm::length(glm::cross(direction_through(camera, 80, 80, x + 0.5, y + 0.5), glm::dvec3(0, 0, -10))) / 2;
            if (sine < 0.502 || sine > 0.998) continue;
            ++total;
            differing += !(glm::length(a.at(x, y) - b.at(x, y)) < 1e-6f);
        }
    EXPECT_GT(total, 1000);
    EXPECT_EQ(differing, 0);
    EXPECT_LT(a.counts.reflection, b.counts.reflection);  // the middle lets through
}

// Clear things that are no spheres let rays go straight on.
TEST(Shading, ClearPaneChangesNothingBehindIt) {
    Scene scene;
    scene.viewer = viewer_along_z(64, 64, 40);
    scene.planes.push_back(wall(-10, {matte, GridTexture{1}}));
    scene.lights.push_back(white_light({1, 2, -6}));
    const Picture without = picture_of(scene);
    scene.planes.push_back(wall(-3, surface({0, 0, 0}, see_through)));
    const Picture behind_plane = picture_of(scene);
    scene.planes.pop_back();
    scene.faces.push_back(
        {.texture = surface({0, 0, 0}, see_through), .a = {-50, -50, -3}, .b = {50, -50, -3}, .c = {0, 90, -3}});
    EXPECT_LE(share_of_differing(without, behind_plane, 1e-5), 0.003);
    EXPECT_LE(share_of_differing(without, picture_of(scene), 1e-5), 0.003);
    EXPECT_EQ(behind_plane.counts.refraction, 64u * 64u);
}

// A triangle in an OBJ file of its own, with vertex normals.
class SmoothTriangle : public testing::Test {
  protected:
    void SetUp() override {
        file_ =
            std::filesystem::temp_directory_path() /
            ("raywalk_smooth_" + std::to_string(static_cast<long>(::testing::UnitTest::GetInstance()->random_seed())) +
             std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".obj");
    }
    void TearDown() override { std::filesystem::remove(file_); }
    Scene with_mesh(const std::string& obj, const Material& material) {
        std::ofstream(file_) << obj;
        Scene scene;
        scene.viewer = viewer_along_z(40, 40, 30);
        scene.meshes.push_back({.texture = surface({1, 1, 1}, material),
                                .file = file_,
                                .where = {},
                                .center = {0, 0, -5},
                                .radius = 1,
                                .smooth = true});
        return scene;
    }
    std::filesystem::path file_;
};

TEST_F(SmoothTriangle, HasTheInterpolatedNormalsOfUnitLength) {
    Scene scene = with_mesh(
        "v 1 0 0\nv -0.5 0.8660254037844386 0\nv -0.5 -0.8660254037844386 0\n"
        "vn 1 0 1\nvn 0 1 1\nvn -1 -1 3\nf 1//1 2//2 3//3\n",
        matte);
    const glm::dvec3 light(0.4, 0.7, -1);
    scene.lights.push_back(white_light(light));
    const Picture picture = picture_of(scene);
    const Camera camera = opening_camera(scene.viewer, 1);
    const glm::dvec3 corner[] = {{1, 0, -5}, {-0.5, std::sqrt(0.75), -5}, {-0.5, -std::sqrt(0.75), -5}};
    const glm::dvec3 normal[] = {glm::normalize(glm::dvec3(1, 0, 1)), glm::normalize(glm::dvec3(0, 1, 1)),
                                 glm::normalize(glm::dvec3(-1, -1, 3))};
    const double whole = glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    int checked = 0;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const glm::dvec3 d = direction_through(camera, 40, 40, x + 0.5, y + 0.5), p = d * (-5 / d.z);
            double weight[3], sum = 0;
            for (int i = 0; i < 3; ++i)
                sum += weight[i] = glm::length(glm::cross(corner[(i + 1) % 3] - p, corner[(i + 2) % 3] - p)) / whole;
            if (sum > 1 + 1e-9) continue;  // outside
            const glm::dvec3 n = glm::normalize(weight[0] * normal[0] + weight[1] * normal[1] + weight[2] * normal[2]);
            const double distance = glm::length(light - p);
            const double expected =
                std::exp(-mu * (distance + glm::length(p))) * std::max(0.0, glm::dot(n, (light - p) / distance));
            EXPECT_NEAR(picture.at(x, y).x, expected, 3e-6) << x << ", " << y;
            ++checked;
        }
    EXPECT_GT(checked, 200);
}

// Normals that cancel in the middle: the geometric normal stands in, and no pixel is lost.
TEST_F(SmoothTriangle, OppositeNormalsGiveNoNan) {
    Scene scene = with_mesh(
        "v 1 0 0\nv -0.5 0.8660254037844386 0\nv -0.5 -0.8660254037844386 0\n"
        "vn 0 1 0\nvn 0 -1 0\nf 1//1 2//2 3//2\nf 1//1 2//2 3//1\nf 1//2 2//1 3//1\n",
        {"mirror", 0, 0.5, 5, 0.5, 0.5});
    scene.lights.push_back(white_light({0, 0, 0}));
    EXPECT_EQ(picture_of(scene).counts.dropped_samples, 0u);
}

// A picture of texels that tell their row and column, looked at from above.
TEST(Texturing, ImageShowsTheTexelUnderEveryPoint) {
    Scene scene;
    scene.viewer = viewer_along_z(64, 48, 30);
    scene.viewer.viewport = {16, 12};
    scene.planes.push_back(wall(-10, surface({1, 1, 1}, matte)));
    scene.lights.push_back(white_light({0, 0, 90}));
    CompiledScene with_image = compiled(scene);
    const int rows = 5, columns = 7;
    const float size = 4;
    with_image.images = {{.first_texel = 2, .width = columns, .height = rows}};
    with_image.texels = {0, 0};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            with_image.texels.push_back(static_cast<std::uint32_t>(row * 40 + 20) |
                                        static_cast<std::uint32_t>(column * 30 + 20) << 8 | 255u << 16);
    SurfaceRecord& record = with_image.surfaces[static_cast<std::size_t>(with_image.planes[0].surface)];
    record.pattern = Pattern::image;
    record.scale = 1 / size;
    record.image = 0;
    const Picture picture = picture_of(with_image, opening_camera(scene.viewer, 4.0 / 3), 64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const double px = (x + 0.5) / 64 * 16 - 8, py = 6 - (y + 0.5) / 48 * 12;
            const double u = -px, v = -py;  // spec 4.6: x' = (-n.z, 0, n.x), y' = (0, -n.z, n.y) for n = (0, 0, 1)
            const auto frac = [](double a) { return a - std::floor(a); };
            const double a = frac(u / size) * rows, b = frac(v / size) * columns;
            if (std::abs(a - std::round(a)) < 1e-4 || std::abs(b - std::round(b)) < 1e-4) continue;
            const glm::vec3 pixel = picture.at(x, y);
            EXPECT_NEAR(pixel.x / pixel.z * 255, std::floor(a) * 40 + 20, 0.01) << x << ", " << y;
            EXPECT_NEAR(pixel.y / pixel.z * 255, std::floor(b) * 30 + 20, 0.01) << x << ", " << y;
        }
}

TEST(Texturing, ImageStaysWholeFarOutAndAtItsEdges) {
    Scene scene;
    scene.viewer = viewer_along_z(64, 64, 170);
    scene.planes.push_back({.texture = surface({1, 1, 1}, matte), .normal = {0, 1, 0}, .offset = -1e6});
    scene.planes.push_back({.texture = surface({1, 1, 1}, matte), .normal = {0, -1, 0}, .offset = -1e-3});
    scene.lights.push_back(white_light({0, 0, 0}));
    CompiledScene with_image = compiled(scene);
    with_image.images = {{.first_texel = 0, .width = 3, .height = 3}};
    with_image.texels.assign(9, 0x00ffffffu);
    with_image.surfaces[0].pattern = Pattern::image;
    with_image.surfaces[0].scale = 1e30f;  // coordinates beyond any fraction
    const Picture picture = picture_of(with_image, opening_camera(scene.viewer, 1), 64, 64);
    EXPECT_EQ(picture.counts.dropped_samples, 0u);
}

// Longitude and latitude: 2 pi u = atan2(n.y, n.x), 2 pi v = asin(n.z), continuous but for one seam.
TEST(Texturing, GridOnASphereFollowsLongitudeAndLatitude) {
    Scene scene;
    scene.viewer = viewer_along_z(100, 100, 30);
    scene.viewer.viewport = {4, 4};
    scene.spheres.push_back({.texture = {matte, GridTexture{16}}, .center = {0, 0, -6}, .radius = 1.9});
    scene.lights.push_back(white_light({0, 0, 50}));
    const Picture picture = picture_of(scene);
    int checked = 0;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const double px = (x + 0.5) / 25 - 2, py = 2 - (y + 0.5) / 25, squared = px * px + py * py;
            if (squared > 1.85 * 1.85) continue;
            const glm::dvec3 n = glm::dvec3(px, py, std::sqrt(1.9 * 1.9 - squared)) / 1.9;
            const double u = 16 * std::atan2(n.y, n.x) / (2 * pi), v = 16 * std::asin(n.z) / (2 * pi);
            if (std::abs(u - std::round(u)) < 1e-3 || std::abs(v - std::round(v)) < 1e-3) continue;
            const bool white = std::fmod(std::abs(std::floor(u) + std::floor(v)), 2) == 1;
            EXPECT_EQ(picture.at(x, y).x > 0, white) << x << ", " << y;
            ++checked;
        }
    EXPECT_GT(checked, 5000);
}

}  // namespace
}  // namespace raywalk
