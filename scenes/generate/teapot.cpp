#include "scenes/generate/teapot.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace generate {
namespace {

// Sixteen control points, u along the rows. Here z is up, as in the published data.
using Patch = std::array<std::array<glm::vec3, 4>, 4>;

// The round parts are four quarters each. A quarter's rows of control points lie at one height and follow from the
// radius alone: Newell took 0.56 where the best circle would have 0.5523.
struct Ring {
    float radius, height;
};
using Profile = std::array<Ring, 4>;
constexpr float roundness = 0.56f;
constexpr Profile round_parts[] = {
    {{{1.4f, 2.4f}, {1.3375f, 2.53125f}, {1.4375f, 2.53125f}, {1.5f, 2.4f}}},  // rim
    {{{1.5f, 2.4f}, {1.75f, 1.875f}, {2.0f, 1.35f}, {2.0f, 0.9f}}},            // body, upper half
    {{{2.0f, 0.9f}, {2.0f, 0.45f}, {1.5f, 0.225f}, {1.5f, 0.15f}}},            // body, lower half
    {{{0.0f, 3.15f}, {0.8f, 3.15f}, {0.0f, 2.85f}, {0.2f, 2.7f}}},             // knob
    {{{0.2f, 2.7f}, {0.4f, 2.55f}, {1.3f, 2.55f}, {1.3f, 2.4f}}},              // lid
    {{{1.5f, 0.15f}, {1.5f, 0.075f}, {1.425f, 0.0f}, {0.0f, 0.0f}}},           // bottom
};

// Handle and spout are two patches long and mirrored at y = 0. Each row goes from the plane of symmetry round to it:
// x, height of its two ends, then the half width of the two points between, whose x and height follow the ends.
struct Rib {
    float x0, z0, x1, z1, half_width;
};
using Limb = std::array<Rib, 7>;  // the middle row belongs to both patches
constexpr Limb handle = {{{-1.6f, 2.025f, -1.5f, 2.25f, 0.3f},
                          {-2.3f, 2.025f, -2.5f, 2.25f, 0.3f},
                          {-2.7f, 2.025f, -3.0f, 2.25f, 0.3f},
                          {-2.7f, 1.8f, -3.0f, 1.8f, 0.3f},
                          {-2.7f, 1.575f, -3.0f, 1.35f, 0.3f},
                          {-2.5f, 1.125f, -2.65f, 0.9375f, 0.3f},
                          {-2.0f, 0.9f, -1.9f, 0.6f, 0.3f}}};
constexpr Limb spout = {{{1.7f, 1.425f, 1.7f, 0.6f, 0.66f},
                         {2.6f, 1.425f, 3.1f, 0.825f, 0.66f},
                         {2.3f, 2.1f, 2.4f, 2.025f, 0.25f},
                         {2.7f, 2.4f, 3.3f, 2.4f, 0.25f},
                         {2.8f, 2.475f, 3.525f, 2.49375f, 0.25f},
                         {2.9f, 2.475f, 3.45f, 2.5125f, 0.15f},
                         {2.8f, 2.4f, 3.2f, 2.4f, 0.15f}}};

Patch quarter(const Profile& profile, int turn) {
    constexpr std::array<std::array<float, 2>, 4> arc = {{{1, 0}, {1, roundness}, {roundness, 1}, {0, 1}}};
    Patch patch;
    for (int row = 0; row < 4; ++row)
        for (int i = 0; i < 4; ++i) {
            float x = profile[row].radius * arc[i][0], y = profile[row].radius * arc[i][1];
            for (int t = 0; t < turn; ++t) {
                const float old = x;
                x = -y;
                y = old;
            }
            patch[row][i] = {x, y, profile[row].height};
        }
    return patch;
}

Patch half(const Limb& limb, int first, float side) {
    Patch patch;
    for (int row = 0; row < 4; ++row) {
        const Rib& rib = limb[first + row];
        patch[row] = {glm::vec3{rib.x0, 0, rib.z0}, glm::vec3{rib.x0, side * rib.half_width, rib.z0},
                      glm::vec3{rib.x1, side * rib.half_width, rib.z1}, glm::vec3{rib.x1, 0, rib.z1}};
    }
    return patch;
}

// The point at t of a cubic Bezier curve, and its derivative.
std::array<glm::vec3, 2> curve(const std::array<glm::vec3, 4>& p, float t) {
    const float s = 1 - t;
    return {s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3],
            3 * s * s * (p[1] - p[0]) + 6 * s * t * (p[2] - p[1]) + 3 * t * t * (p[3] - p[2])};
}

struct SurfacePoint {
    glm::vec3 position, normal;
};

SurfacePoint evaluate(const Patch& patch, float u, float v) {
    std::array<glm::vec3, 4> along, slope;
    for (int row = 0; row < 4; ++row) {
        const auto [point, tangent] = curve(patch[row], v);
        along[row] = point;
        slope[row] = tangent;
    }
    const auto [position, du] = curve(along, u);
    return {position, glm::cross(du, curve(slope, u)[0])};
}

void tessellate(const Patch& patch, int steps, bool turned, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto across = static_cast<std::uint32_t>(steps + 1);
    const auto y_up = [](const glm::vec3& p) { return glm::vec3(p.x, p.z, -p.y); };
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= steps; ++j) {
            const float u = static_cast<float>(i) / static_cast<float>(steps);
            const float v = static_cast<float>(j) / static_cast<float>(steps);
            const SurfacePoint at = evaluate(patch, u, v);
            glm::vec3 normal = at.normal;
            // Where a row of control points is one point, the patch has no normal: take that of a point close by.
            if (glm::length(normal) < 1e-6f)
                normal = evaluate(patch, std::lerp(u, 0.5f, 1e-3f), std::lerp(v, 0.5f, 1e-3f)).normal;
            normal = glm::normalize(turned ? -normal : normal);
            if (std::abs(at.position.x) + std::abs(at.position.y) < 1e-6f) normal = {0, 0, normal.z < 0 ? -1 : 1};
            mesh.positions.push_back(y_up(at.position));
            mesh.normals.push_back(y_up(normal));
        }
    for (std::uint32_t i = 0; i < across - 1; ++i)
        for (std::uint32_t j = 0; j < across - 1; ++j) {
            const std::uint32_t a = first + i * across + j, b = a + 1, c = a + across, d = c + 1;
            if (turned) {
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({a, d, c});
            } else {
                mesh.faces.push_back({a, d, b});
                mesh.faces.push_back({a, c, d});
            }
        }
}

}  // namespace

Mesh teapot(int steps) {
    Mesh mesh;
    for (const Profile& part : round_parts)
        for (int turn = 0; turn < 4; ++turn) tessellate(quarter(part, turn), steps, false, mesh);
    for (const Limb* limb : {&handle, &spout})
        for (const int first : {0, 3})
            for (const float side : {1.0f, -1.0f}) tessellate(half(*limb, first, side), steps, side < 0, mesh);
    return welded(mesh, 1e-5f);
}

}  // namespace generate
