#include "scenes/generate/sculpture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scenes/generate/surface_nets.h"

namespace generate {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Scherk's second minimal surface, sin z = sinh x sinh y, is a tower of saddles with a hole between each two. Bent into
// a ring, after the sculptor Brent Collins and Carlo Sequin (1995): z runs along the ring, one storey for every pi,
// while the cross-section (x, y) turns. It closes where an odd number of storeys meets an odd number of quarter turns,
// since either changes the sign of its side.
struct SaddleRing {
    int storeys;
    int quarter_turns;
    float ring_radius;  // storeys / 2 would keep the proportions of the tower
    float reach;        // radius of the cross-section at which the surface is cut off
    float thickness;    // half the thickness of the sheet
    float bead;         // radius of the round seam along its edges

    // About the distance to the surface, negative inside.
    float operator()(const glm::vec3& p) const {
        const float radius = std::max(std::hypot(p.x, p.y), 1e-3f), angle = std::atan2(p.y, p.x);
        const float out = radius - ring_radius, off = std::hypot(out, p.z);
        if (off > reach + 2 * bead) return off - reach - bead;

        const float twist =
            0.25f * static_cast<float>(quarter_turns);  // turns of the cross-section per turn of the ring
        const float c = std::cos(twist * angle), s = std::sin(twist * angle);
        const float x = c * out + s * p.z, y = -s * out + c * p.z;
        const float z = 0.5f * static_cast<float>(storeys) * angle;
        const float value = std::sinh(x) * std::sinh(y) - std::sin(z);
        const float slope_x = std::cosh(x) * std::sinh(y), slope_y = std::sinh(x) * std::cosh(y);
        const float slope_angle =
            twist * (slope_x * y - slope_y * x) - 0.5f * static_cast<float>(storeys) * std::cos(z);
        const float slope =
            std::sqrt(slope_x * slope_x + slope_y * slope_y + slope_angle * slope_angle / (radius * radius));
        const float from_sheet = value / std::max(slope, 0.15f);

        const float sheet = std::max(std::abs(from_sheet) - thickness, off - reach);
        const float seam = std::hypot(from_sheet, off - reach) - bead;
        // Polynomial smooth minimum of the two.
        const float blend = 1.2f * bead, h = std::max(blend - std::abs(sheet - seam), 0.0f) / blend;
        return std::min(sheet, seam) - h * h * blend * 0.25f;
    }
};

}  // namespace

Mesh saddle_ring(float detail) {
    const SaddleRing ring{
        .storeys = 7, .quarter_turns = 3, .ring_radius = 3.9f, .reach = 2.15f, .thickness = 0.085f, .bead = 0.15f};
    const float wide = ring.ring_radius + ring.reach + 2 * ring.bead + 0.2f, deep = ring.reach + 2 * ring.bead + 0.2f;
    return surface_nets(ring, {-wide, -wide, -deep}, {wide, wide, deep}, 0.08f / detail);
}

Mesh trefoil_knot(int along, int around) {
    const auto center = [](float t) {
        return glm::vec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t));
    };
    Mesh mesh;
    for (int i = 0; i < along; ++i) {
        const float t = 2 * pi * static_cast<float>(i) / static_cast<float>(along), dt = 1e-2f;
        const glm::vec3 tangent = glm::normalize(center(t + dt) - center(t - dt));
        // The direction from the knot's middle never lies along the tangent, so it makes a frame that closes.
        const glm::vec3 side = glm::normalize(glm::cross(tangent, center(t)));
        const glm::vec3 out = glm::cross(side, tangent);
        for (int j = 0; j < around; ++j) {
            const float a = 2 * pi * static_cast<float>(j) / static_cast<float>(around);
            mesh.positions.push_back(center(t) + 0.62f * (std::cos(a) * out + std::sin(a) * side));
        }
    }
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>((i % along) * around + j % around); };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
            mesh.faces.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
        }
    return mesh;
}

}  // namespace generate
