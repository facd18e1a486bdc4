#include "scenes/generate/noise.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace generate {
namespace {

int wrap(int x, int period) { return ((x % period) + period) % period; }

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

std::uint32_t hash(int x, int y, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9e3779b9u ^ static_cast<std::uint32_t>(x) * 0x85ebca6bu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du ^ static_cast<std::uint32_t>(y) * 0xc2b2ae35u;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    h = (h ^ (h >> 15)) * 0x165667b1u;
    return h ^ (h >> 16);
}

float hash_unit(int x, int y, std::uint32_t seed) { return static_cast<float>(hash(x, y, seed) >> 8) * 0x1p-24f; }

float gradient_noise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed) {
    const glm::vec2 cell = {std::floor(p.x), std::floor(p.y)};
    const glm::vec2 f = p - cell;
    const auto corner = [&](int dx, int dy) {
        const float angle = 6.2831853f * hash_unit(wrap(static_cast<int>(cell.x) + dx, period.x),
                                                   wrap(static_cast<int>(cell.y) + dy, period.y), seed);
        return std::cos(angle) * (f.x - static_cast<float>(dx)) + std::sin(angle) * (f.y - static_cast<float>(dy));
    };
    const float u = fade(f.x), v = fade(f.y);
    const float low = std::lerp(corner(0, 0), corner(1, 0), u);
    const float high = std::lerp(corner(0, 1), corner(1, 1), u);
    return 1.4142136f * std::lerp(low, high, v);
}

float fractal_noise(glm::vec2 p, glm::ivec2 period, int octaves, std::uint32_t seed) {
    float sum = 0, weight = 0.5f;
    for (int octave = 0; octave < octaves; ++octave, p *= 2.0f, period *= 2, weight *= 0.5f)
        sum += weight * gradient_noise(p, period, seed + static_cast<std::uint32_t>(octave));
    return sum;
}

Cell cellular_noise(glm::vec2 p, int period, float jitter, std::uint32_t seed) {
    const int x0 = static_cast<int>(std::floor(p.x)), y0 = static_cast<int>(std::floor(p.y));
    const auto point = [&](int x, int y) {
        const int wx = wrap(x, period), wy = wrap(y, period);
        return glm::vec2(x, y) + 0.5f +
               jitter * (glm::vec2(hash_unit(wx, wy, seed), hash_unit(wx, wy, seed + 1)) - 0.5f);
    };
    float best = std::numeric_limits<float>::max();
    int bx = x0, by = y0;
    for (int y = y0 - 1; y <= y0 + 1; ++y)
        for (int x = x0 - 1; x <= x0 + 1; ++x)
            if (const float d = glm::distance(point(x, y), p); d < best) best = d, bx = x, by = y;
    // The border is the bisector of the nearest point and the neighbour whose bisector is closest.
    const glm::vec2 near = point(bx, by);
    float border = std::numeric_limits<float>::max();
    for (int y = by - 2; y <= by + 2; ++y)
        for (int x = bx - 2; x <= bx + 2; ++x) {
            if (x == bx && y == by) continue;
            const glm::vec2 other = point(x, y);
            border = std::min(border, glm::dot((near + other) * 0.5f - p, glm::normalize(other - near)));
        }
    return {border, hash(wrap(bx, period), wrap(by, period), seed + 2)};
}

}  // namespace generate
