// Scenes built in code for the traversal's tests, and the slow exact answer to every ray.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/kernels.h"

namespace raywalk::traversal_test {

struct ShapeSet {
    std::string name;
    std::vector<TriangleCorners> triangles = {};
    std::vector<SphereShape> spheres = {};
    std::vector<PlaneRecord> planes = {};
};

inline CompiledScene compile_shapes(const ShapeSet& set, Accelerator accelerator) {
    CompiledScene scene;
    scene.triangle_count = static_cast<std::int32_t>(set.triangles.size());
    scene.sphere_count = static_cast<std::int32_t>(set.spheres.size());
    scene.plane_count = static_cast<std::int32_t>(set.planes.size());
    const Shapes shapes = {set.triangles, set.spheres};
    scene.hierarchy = accelerator == Accelerator::bvh ? build_bvh(shapes) : build_kd_tree(shapes, {});
    scene.planes.assign(set.planes.begin(), set.planes.end());
    return scene;
}

struct Random {
    std::mt19937 engine;
    explicit Random(unsigned seed) : engine(seed) {}
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); }
    glm::vec3 point(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    glm::vec3 direction() {
        for (;;) {
            const glm::vec3 p = point(1);
            const float squared = glm::dot(p, p);
            if (squared > 1e-3f && squared < 1) return p / std::sqrt(squared);
        }
    }
};

// Unit sphere of 20 * 4^levels triangles around the origin: closed, so that no ray may slip out.
inline std::vector<TriangleCorners> icosphere(int levels) {
    const float g = (1 + std::sqrt(5.0f)) / 2;
    const glm::vec3 v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    const int f[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    std::vector<TriangleCorners> mesh;
    for (const auto& t : f)
        mesh.push_back({{glm::normalize(v[t[0]]), glm::normalize(v[t[1]]), glm::normalize(v[t[2]])}});
    for (int level = 0; level < levels; ++level) {
        std::vector<TriangleCorners> finer;
        for (const auto& [p] : mesh) {
            // The middle of an edge must be the same number from both sides: + commutes, so it is.
            const glm::vec3 m[3] = {glm::normalize(p[0] + p[1]), glm::normalize(p[1] + p[2]),
                                    glm::normalize(p[2] + p[0])};
            finer.push_back({{p[0], m[0], m[2]}});
            finer.push_back({{m[0], p[1], m[1]}});
            finer.push_back({{m[2], m[1], p[2]}});
            finer.push_back({{m[0], m[1], m[2]}});
        }
        mesh = std::move(finer);
    }
    return mesh;
}

inline PlaneRecord plane(glm::vec3 normal, float offset) {
    PlaneRecord record{};
    normal = glm::normalize(normal);
    for (int a = 0; a < 3; ++a) record.normal[a] = normal[a];
    record.offset = offset;
    return record;
}

inline ShapeSet triangle_soup(int count, float size, unsigned seed) {
    ShapeSet set{.name = "soup of " + std::to_string(count)};
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const glm::vec3 center = random.point(10);
        set.triangles.push_back(
            {{center + random.point(size), center + random.point(size), center + random.point(size)}});
    }
    return set;
}

inline std::vector<ShapeSet> all_shape_sets() {
    std::vector<ShapeSet> sets;
    sets.push_back({.name = "nothing"});
    sets.push_back({.name = "one triangle", .triangles = {{{{-1, -1, 0}, {2, -1, 0}, {0, 2, 0.5f}}}}});
    sets.push_back({.name = "one sphere", .spheres = {{{1, 2, 3}, 2.5f}}});
    sets.push_back({.name = "planes alone", .planes = {plane({0, 1, 0}, -4), plane({1, 0.5f, 0}, -6)}});
    sets.push_back(triangle_soup(17, 4, 1));
    sets.push_back(triangle_soup(3000, 0.8f, 2));
    {
        ShapeSet set = triangle_soup(1500, 1, 3);
        set.name = "triangles, spheres and planes";
        Random random(4);
        for (int i = 0; i < 1500; ++i) set.spheres.push_back({random.point(10), random.between(0.01f, 0.8f)});
        set.planes = {plane({0, 1, 0}, -11), plane({0, 0, 1}, -12)};
        sets.push_back(set);
    }
    {
        // Every box flat: a wall of axis-aligned tiles, and the same tiles again (coincident).
        ShapeSet set{.name = "flat and coincident"};
        for (int copy = 0; copy < 2; ++copy)
            for (int i = -8; i < 8; ++i)
                for (int j = -8; j < 8; ++j) {
                    const float x = static_cast<float>(i), y = static_cast<float>(j);
                    set.triangles.push_back({{{x, y, 2}, {x + 1, y, 2}, {x, y + 1, 2}}});
                    set.triangles.push_back({{{x + 1, y, 2}, {x + 1, y + 1, 2}, {x, y + 1, 2}}});
                    set.triangles.push_back({{{3, x, y}, {3, x + 1, y}, {3, x, y + 1}}});
                }
        sets.push_back(set);
    }
    {
        ShapeSet set{.name = "slivers and points"};
        Random random(5);
        for (int i = 0; i < 600; ++i) {
            const glm::vec3 a = random.point(8), along = random.direction() * 6.0f;
            set.triangles.push_back({{a, a + along, a + along * 0.5f + random.point(1e-4f)}});
            set.triangles.push_back({{a, a, a}});
            set.triangles.push_back({{a, a + along, a}});
        }
        sets.push_back(set);
    }
    {
        ShapeSet set{.name = "far from the origin"};
        Random random(6);
        for (const auto& [p] : icosphere(3))
            set.triangles.push_back({{p[0] + 3000.0f, p[1] + 3000.0f, p[2] + 3000.0f}});
        for (int i = 0; i < 50; ++i) set.spheres.push_back({glm::vec3(3000) + random.point(5), 0.3f});
        sets.push_back(set);
    }
    sets.push_back({.name = "closed mesh", .triangles = icosphere(4)});
    return sets;
}

// The exact hit of one shape in double precision. `margin`: how far inside (negative: outside) its edge the ray passes,
// in barycentric weight or relative to the radius; -inf where it does not come near.
struct ExactHit {
    double t = std::numeric_limits<double>::infinity();
    double margin = -std::numeric_limits<double>::infinity();
};

inline ExactHit exact_triangle(const TriangleCorners& triangle, glm::dvec3 o, glm::dvec3 d) {
    const glm::dvec3 a = triangle.p[0], e1 = glm::dvec3(triangle.p[1]) - a, e2 = glm::dvec3(triangle.p[2]) - a;
    const glm::dvec3 p = glm::cross(d, e2), s = o - a, q = glm::cross(s, e1);
    const double det = glm::dot(e1, p);
    if (det == 0) return {};
    const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
    return {glm::dot(e2, q) / det, std::min({u, v, 1 - u - v})};
}

inline ExactHit exact_sphere(const SphereShape& sphere, glm::dvec3 o, glm::dvec3 d, bool far_side) {
    const glm::dvec3 c = glm::dvec3(sphere.center) - o;
    const double dd = glm::dot(d, d), b = glm::dot(c, d) / dd;
    const glm::dvec3 p = c - b * d;
    const double r = sphere.radius, disc = r * r - glm::dot(p, p);
    const double half = std::sqrt(std::max(disc, 0.0) / dd);
    return {far_side ? b + half : b - half, disc / (r * r)};
}

inline ExactHit exact_plane(const PlaneRecord& plane, glm::dvec3 o, glm::dvec3 d) {
    const glm::dvec3 n = {plane.normal[0], plane.normal[1], plane.normal[2]};
    return {(plane.offset - glm::dot(n, o)) / glm::dot(n, d), 1};
}

}  // namespace raywalk::traversal_test
