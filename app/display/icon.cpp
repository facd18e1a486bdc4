#include "app/display/icon.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace raywalk {
namespace {

using Color = std::array<double, 4>;

// The icon at (x, y) of the unit square, y down.
Color color_at(double x, double y) {
    constexpr double horizon = 0.45, radius = 0.34;
    const double bx = (x - 0.5) / radius, by = (y - 0.46) / radius, squared = bx * bx + by * by;
    if (squared < 1) {  // lit from the upper left
        const double z = std::sqrt(1 - squared);
        const double light = std::max(0.0, -0.5 * bx - 0.6 * by + 0.62 * z);
        const double highlight = std::pow(light, 40);
        return {std::min(1.0, 0.15 + 0.75 * light + highlight), std::min(1.0, 0.08 + 0.32 * light + highlight),
                std::min(1.0, 0.06 + 0.12 * light + highlight), 1};
    }
    if (y < horizon) return {0.45 + 0.4 * y, 0.6 + 0.4 * y, 0.9, 1};
    const double depth = 0.25 / (y - horizon + 0.04), across = (x - 0.5) * depth;
    const bool dark = (static_cast<int>(std::floor(across * 2.5)) + static_cast<int>(std::floor(depth * 2.5))) % 2 != 0;
    const double grey = dark ? 0.25 : 0.85;
    return {grey, grey, grey, 1};
}

}  // namespace

std::vector<std::uint8_t> icon_pixels(int side) {
    constexpr int sub = 4;  // samples along each side of a pixel
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            Color sum{};
            for (int y = 0; y < sub; ++y)
                for (int x = 0; x < sub; ++x) {
                    const Color color = color_at((column + (x + 0.5) / sub) / side, (row + (y + 0.5) / sub) / side);
                    for (std::size_t c = 0; c < 4; ++c) sum[c] += color[c];
                }
            for (const double channel : sum)
                pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * channel / (sub * sub))));
        }
    return pixels;
}

}  // namespace raywalk
