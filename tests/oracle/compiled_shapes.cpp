#include "tests/oracle/compiled_shapes.h"

#include <cfloat>
#include <cmath>
#include <limits>
#include <numbers>

namespace raywalk::testing {

std::vector<TriangleCorners> triangle_soup(std::uint32_t seed, int count, float size) {
    Random random(seed);
    std::vector<TriangleCorners> triangles(static_cast<std::size_t>(count));
    for (TriangleCorners& t : triangles) {
        const glm::vec3 at = random.point(-1, 1);
        for (glm::vec3& p : t.p) p = at + random.point(-size / 2, size / 2);
    }
    return triangles;
}

std::vector<TriangleCorners> bumpy_ball(int n) {
    const auto point = [n](int i, int j) {
        const double polar = std::numbers::pi * i / n, around = 2 * std::numbers::pi * (j % n) / n;
        const double radius = 1 + 0.1 * std::sin(9 * polar) * std::sin(7 * around);
        // On a fine grid, so that what should be 0 is.
        const auto snapped = [](double x) { return static_cast<float>(std::round(x * 0x1p20) * 0x1p-20); };
        return glm::vec3(snapped(radius * std::sin(polar) * std::cos(around)), snapped(radius * std::cos(polar)),
                         snapped(radius * std::sin(polar) * std::sin(around)));
    };
    std::vector<TriangleCorners> triangles;
    triangles.reserve(2 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            triangles.push_back({{point(i, j), point(i + 1, j), point(i + 1, j + 1)}});
            triangles.push_back({{point(i, j), point(i + 1, j + 1), point(i, j + 1)}});
        }
    return triangles;
}

namespace {

void add_rectangle(std::vector<TriangleCorners>& to, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    to.push_back({{corner, corner + u, corner + u + v}});
    to.push_back({{corner, corner + u + v, corner + v}});
}

// Walls on the planes of an integer grid: everything is flat, and planes are shared by many shapes.
std::vector<TriangleCorners> grid_of_walls(int cells) {
    std::vector<TriangleCorners> walls;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const auto a = static_cast<float>(i), b = static_cast<float>(j);
            add_rectangle(walls, {a, b, 0}, {0, 1, 0}, {0, 0, 1});
            add_rectangle(walls, {b, a, 0}, {1, 0, 0}, {0, 0, 1});
            add_rectangle(walls, {b, 0, a}, {1, 0, 0}, {0, 1, 0});
        }
    return walls;
}

std::vector<TriangleCorners> transformed(std::vector<TriangleCorners> triangles, float scale, glm::vec3 shift) {
    for (TriangleCorners& t : triangles)
        for (glm::vec3& p : t.p) p = p * scale + shift;
    return triangles;
}

std::vector<SphereShape> random_spheres(std::uint32_t seed, int count, float smallest, float largest) {
    Random random(seed);
    std::vector<SphereShape> spheres(static_cast<std::size_t>(count));
    for (SphereShape& s : spheres) {
        s.center = random.point(-1, 1);
        s.radius = random.between(smallest, largest);
    }
    return spheres;
}

std::vector<TriangleCorners> fan_of_slivers(int count) {
    std::vector<TriangleCorners> triangles;
    for (int i = 0; i < count; ++i) {
        const float a = 1e-5f * static_cast<float>(i);
        triangles.push_back({{{0, 0, 0}, {1, a, 0.1f}, {1, a + 1e-6f, 0.1f}}});
    }
    return triangles;
}

std::vector<TriangleCorners> without_area(std::uint32_t seed, int count) {
    std::vector<TriangleCorners> triangles = triangle_soup(seed, count, 0.5f);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        auto& p = triangles[i].p;
        if (i % 3 == 0) p[2] = p[1] = p[0];                   // a point
        if (i % 3 == 1) p[2] = p[1];                          // a segment
        if (i % 3 == 2) p[2] = p[0] + (p[1] - p[0]) * 0.25f;  // three points on a line
    }
    return triangles;
}

}  // namespace

std::vector<ShapeSet> awkward_scenes() {
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<ShapeSet> scenes;
    const auto add = [&](std::string name, std::vector<TriangleCorners> triangles,
                         std::vector<SphereShape> spheres = {}) {
        scenes.push_back({std::move(name), std::move(triangles), std::move(spheres)});
    };
    add("nothing", {});
    add("one_triangle", triangle_soup(1, 1, 1));
    add("one_sphere", {}, {{{0.5f, 0, 0}, 2}});
    add("one_flat_triangle", {{{{0, 1, 0}, {0, 0, 1}, {0, 0, 0}}}});
    add("one_point", {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}});
    add("soup_of_small", triangle_soup(2, 300, 0.1f));
    add("soup_of_large", triangle_soup(3, 120, 2));
    add("soup_of_mixed", [] {
        auto all = triangle_soup(4, 150, 0.05f);
        for (const auto& t : triangle_soup(5, 20, 3)) all.push_back(t);
        return all;
    }());
    add("mesh", bumpy_ball(12));
    add("walls", grid_of_walls(6));
    add("walls_at_one_height", transformed(grid_of_walls(5), 1, {-2.5f, 7, 0}));
    add("flat_scene", [] {
        auto flat = triangle_soup(6, 200, 0.2f);
        for (auto& t : flat)
            for (auto& p : t.p) p.y = 0.25f;
        return flat;
    }());
    add("coincident", std::vector(500, triangle_soup(7, 1, 1)[0]));
    add("coincident_flat", std::vector(300, TriangleCorners{{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}}));
    add("coincident_spheres", {}, std::vector(200, SphereShape{{0.1f, 0.2f, 0.3f}, 1}));
    add("two_heaps", [] {
        std::vector<TriangleCorners> heaps(200, triangle_soup(8, 1, 0.1f)[0]);
        heaps.resize(400, triangle_soup(9, 1, 0.1f)[0]);
        return heaps;
    }());
    add("slivers", fan_of_slivers(200));
    add("without_area", without_area(10, 150));
    add("spheres", {}, random_spheres(11, 150, 0.01f, 0.2f));
    add("nested_spheres", {}, [] {
        std::vector<SphereShape> nested;
        for (int i = 1; i <= 60; ++i) nested.push_back({{0, 0, 0}, static_cast<float>(i)});
        return nested;
    }());
    add("tiny_and_huge_spheres", triangle_soup(12, 60, 0.2f), [] {
        auto spheres = random_spheres(13, 60, 1e-6f, 1e-4f);
        spheres.push_back({{0, -1e5f, 0}, 1e5f});
        spheres.push_back({{0, 0, 0}, 1e20f});
        spheres.push_back({{0, 0, 0}, 0});
        return spheres;
    }());
    add("triangles_and_spheres", triangle_soup(14, 150, 0.2f), random_spheres(15, 100, 0.02f, 0.1f));
    add("huge", transformed(triangle_soup(16, 150, 0.3f), 1e30f, {}));
    add("minute", transformed(triangle_soup(17, 150, 0.3f), 1e-30f, {}));
    add("far_away", transformed(triangle_soup(18, 150, 0.3f), 1, {1e6f, -3e6f, 1e6f}));
    add("every_scale", [] {
        std::vector<TriangleCorners> all;
        for (int e = -5; e <= 5; ++e)
            for (const auto& t : transformed(triangle_soup(static_cast<std::uint32_t>(100 + e), 20, 0.5f),
                                             std::pow(10.0f, static_cast<float>(e)), {}))
                all.push_back(t);
        return all;
    }());
    add("largest_floats", {{{{-FLT_MAX, 0, 0}, {FLT_MAX, 1, 0}, {0, FLT_MAX, 1}}}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}},
        {{{FLT_MAX / 2, 0, 0}, FLT_MAX / 4}});
    add("every_float", [] {
        std::vector<TriangleCorners> all;
        for (int e = -120; e <= 120; ++e)
            for (const auto& t : triangle_soup(static_cast<std::uint32_t>(200 + e), 2, 0.5f))
                all.push_back(transformed({t}, std::ldexp(1.0f, e), {})[0]);
        return all;
    }());
    add("not_finite",
        [] {
            auto soup = triangle_soup(19, 90, 0.3f);
            for (std::size_t i = 0; i < soup.size(); i += 9) soup[i].p[i % 3].y = i % 2 == 0 ? nan : infinity;
            return soup;
        }(),
        {{{0, 0, 0}, infinity}, {{nan, 0, 0}, 1}, {{0, 0, 0}, 0.5f}});
    return scenes;
}

}  // namespace raywalk::testing
