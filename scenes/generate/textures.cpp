#include "scenes/generate/textures.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "scenes/generate/noise.h"

namespace generate {
namespace {

// What a texture says of a point p of the unit tile: its colour, and how high it stands (for the light baked in).
struct Sample {
    glm::vec3 color;
    float height;
};

constexpr glm::vec3 rgb(int hex) { return glm::vec3((hex >> 16) & 255, (hex >> 8) & 255, hex & 255) / 255.0f; }

float unit(std::uint32_t h) { return static_cast<float>(h & 0xffffff) * 0x1p-24f; }

// Running bond, four bricks wide and twelve courses high, hand-made: wavering edges, kiln marks, sandy mortar.
Sample brick(glm::vec2 p) {
    constexpr int across = 4, courses = 12;
    const glm::vec2 waver = 0.0022f * glm::vec2(fractal_noise(p * 24.0f, 24, 3, 1), fractal_noise(p * 24.0f, 24, 3, 2));
    const float y = (p.y + waver.y) * courses;
    const int course = static_cast<int>(std::floor(y));
    const float x = (p.x + waver.x) * across + 0.5f * static_cast<float>(course & 1);
    const int column = ((static_cast<int>(std::floor(x)) % across) + across) % across;
    const int row = ((course % courses) + courses) % courses;
    const std::uint32_t id = hash(column, row, 3);
    // Distance to the joint, in units of the tile's side; corners are rounded.
    const glm::vec2 half = glm::vec2(0.5f / across, 0.5f / courses);
    const glm::vec2 to_center =
        glm::abs(glm::vec2((x - std::floor(x) - 0.5f) / across, (y - std::floor(y) - 0.5f) / courses));
    const float corner = 0.006f;
    const glm::vec2 over = glm::max(to_center - (half - corner), glm::vec2(0));
    const float joint =
        corner - glm::length(over) + std::min(0.0f, std::min(half.x - to_center.x, half.y - to_center.y));
    const float solid = glm::smoothstep(0.0018f, 0.0042f, joint);

    const float grain = fractal_noise(p * 64.0f, 64, 4, 4), blotch = fractal_noise(p * 10.0f, 10, 4, 5 + id % 5);
    const float pit = 0.5f * glm::smoothstep(0.40f, 0.7f, gradient_noise(p * 90.0f, 90, 6));
    glm::vec3 clay = glm::mix(rgb(0x8f3f2b), rgb(0xb5654a), unit(id));
    clay = glm::mix(clay, rgb(0x5a2f2a), unit(id * 7919u) > 0.82f ? 0.65f : 0.0f);  // a few burnt headers
    clay = glm::mix(clay, rgb(0xc98f6a), 0.45f * glm::smoothstep(0.05f, 0.5f, blotch));
    clay *= 1.0f + 0.22f * grain - 0.30f * pit;
    const float sand = fractal_noise(p * 128.0f, 128, 3, 7);
    const glm::vec3 mortar = rgb(0xb3aa9a) * (0.92f + 0.30f * sand + 0.08f * fractal_noise(p * 8.0f, 8, 3, 8));
    return {glm::mix(mortar, clay, solid),
            0.0060f * glm::smoothstep(0.0f, 0.008f, joint) + 0.0006f * grain - 0.0014f * pit * solid + 0.0005f * sand};
}

// Flagstones of many shapes, worn round at the edges, with moss in some joints.
Sample stone(glm::vec2 p) {
    const glm::vec2 bent =
        p * 7.0f + 0.16f * glm::vec2(fractal_noise(p * 14.0f, 14, 4, 21), fractal_noise(p * 14.0f, 14, 4, 22));
    const Cell cell = cellular_noise(bent, 7, 0.86f, 23);
    const float solid = glm::smoothstep(0.025f, 0.065f, cell.border);
    const float grain = fractal_noise(p * 48.0f, 48, 5, 24), layer = fractal_noise(p * 9.0f, 9, 5, 25 + cell.id % 7);
    const float speck = glm::smoothstep(0.30f, 0.55f, gradient_noise(p * 150.0f, 150, 33));
    const float tint = unit(cell.id);
    glm::vec3 rock = tint < 0.35f  ? rgb(0x8b8a86)
                     : tint < 0.6f ? rgb(0xa39a8a)
                     : tint < 0.8f ? rgb(0x7a7f86)
                                   : rgb(0x98897a);
    rock *= 0.82f + 0.36f * unit(cell.id * 2654435761u);
    rock *= 1.0f + 0.30f * layer + 0.28f * grain - 0.22f * speck;
    const float vein = std::abs(fractal_noise(p * 11.0f, 11, 5, 40 + cell.id % 5));
    rock = glm::mix(rgb(0xc9c4b8), rock, 0.65f + 0.35f * glm::smoothstep(0.0f, 0.035f, vein));
    const float damp = glm::smoothstep(-0.1f, 0.35f, fractal_noise(p * 5.0f, 5, 3, 50));
    const glm::vec3 soil =
        glm::mix(rgb(0x3d372e), rgb(0x4d5a2c), damp) * (0.9f + 0.8f * fractal_noise(p * 96.0f, 96, 3, 51));
    return {glm::mix(soil, rock, solid),
            0.012f * glm::smoothstep(0.0f, 0.16f, cell.border) + 0.0020f * grain + 0.0022f * layer - 0.0006f * speck};
}

// Eight boards of oak, butted end to end at staggered places.
Sample wood(glm::vec2 p) {
    constexpr int boards = 8;
    const int board = std::clamp(static_cast<int>(p.y * boards), 0, boards - 1);
    const float shift = hash_unit(board, 0, 61);
    const float along = p.x + shift;  // two boards to a row
    const int piece = static_cast<int>(std::floor(along * 2.0f)) & 1;
    const std::uint32_t id = hash(board, piece, 62);
    const float across = p.y * boards - static_cast<float>(board);
    const float end = std::abs(along * 2.0f - std::round(along * 2.0f)) / 2.0f;
    const float side = std::min(across, 1.0f - across) / boards;
    const float gap = std::min(side, end);

    // Cathedral figure: year rings cut along the trunk, the pith a little beside the board and wandering with it.
    const std::uint32_t seed = 70 + id % 997 * 8;
    const float wander = fractal_noise({p.x * 3, p.y * 16}, {3, 16}, 3, seed);
    const float x = (across - 0.5f + 1.3f * (unit(id * 31u) - 0.5f)) * 1.6f + 0.22f * wander;
    const float depth = 0.35f + 0.5f * (0.5f + 0.5f * gradient_noise({p.x * 2, 0.5f}, {2, 1}, seed + 1));
    const float ring =
        std::sqrt(x * x + depth * depth) * 11.0f + 0.35f * fractal_noise({p.x * 8, p.y * 64}, {8, 64}, 3, seed + 2);
    const float year = ring - std::floor(ring);
    const float late = glm::smoothstep(0.35f, 0.92f, year) * (1.0f - glm::smoothstep(0.94f, 1.0f, year));
    const float fibre = fractal_noise({p.x * 20, p.y * 400}, {20, 400}, 3, 63);
    const float pore =
        glm::smoothstep(0.22f, 0.55f, gradient_noise({p.x * 28, p.y * 300}, {28, 300}, 64)) * (0.35f + 0.65f * late);

    glm::vec3 color = glm::mix(rgb(0xb98450), rgb(0x8a5a30), 0.75f * late);
    color = glm::mix(color, rgb(0xd2a472), 0.25f * (0.5f + wander));
    color *= 0.84f + 0.30f * unit(id * 16807u);
    color *= 1.0f + 0.16f * fibre - 0.30f * pore;
    const float closed = glm::smoothstep(0.0006f, 0.0022f, gap);
    return {color * (0.30f + 0.70f * closed),
            0.003f * glm::smoothstep(0.0f, 0.004f, gap) + 0.0002f * fibre - 0.0003f * pore};
}

// Painted, glazed tiles, two by two: a star, quarter rosettes in the corners that close to circles, a fine frame.
Sample tiles(glm::vec2 p) {
    const glm::vec2 scaled = p * 2.0f;
    const glm::vec2 cell = glm::floor(scaled);
    const std::uint32_t id = hash(static_cast<int>(cell.x), static_cast<int>(cell.y), 81);
    const glm::vec2 brush =
        0.0035f * glm::vec2(fractal_noise(p * 40.0f, 40, 3, 82), fractal_noise(p * 40.0f, 40, 3, 83));
    const glm::vec2 exact = glm::abs(scaled - cell - 0.5f);
    const glm::vec2 q = glm::abs(scaled - cell - 0.5f + brush);  // 0..0.5, mirrored into one quarter
    const glm::vec2 d = q.x > q.y ? q : glm::vec2(q.y, q.x);     // and into one eighth
    const auto ink = [](float distance) { return glm::smoothstep(0.004f, -0.004f, distance); };

    const glm::vec3 glaze = rgb(0xece6d6), deep = rgb(0x1f3f7f), light = rgb(0x6f94c9), ochre = rgb(0xcf9a3d);
    const float r = glm::length(q), corner = glm::length(q - 0.5f);
    const float angle = std::atan2(q.y, q.x);
    glm::vec3 color = glaze;
    const auto paint = [&](float distance, glm::vec3 with) { color = glm::mix(color, with, ink(distance)); };

    const float petal = 0.17f + 0.085f * std::cos(8.0f * angle);
    paint(r - petal - 0.022f, deep);
    paint(r - petal, light);
    paint(r - (0.085f + 0.030f * std::cos(8.0f * angle)), glaze);
    paint(r - 0.040f, ochre);
    // The eight-pointed frame around the star: two squares.
    const float square = d.x, diamond = (q.x + q.y) * 0.70710678f;
    paint(std::abs(std::max(square - 0.315f, diamond - 0.415f)) - 0.011f, deep);
    paint(std::abs(std::max(square - 0.345f, diamond - 0.445f)) - 0.004f, ochre);
    // Rosettes that four tiles share.
    const float lobe = 0.135f + 0.030f * std::cos(8.0f * std::atan2(0.5f - q.y, 0.5f - q.x));
    paint(corner - lobe - 0.018f, deep);
    paint(corner - lobe, ochre);
    paint(corner - lobe * 0.62f, deep);
    paint(corner - 0.045f, glaze);
    paint(glm::length(d - glm::vec2(0.415f, 0.0f)) - 0.038f, deep);
    paint(glm::length(d - glm::vec2(0.415f, 0.0f)) - 0.018f, ochre);

    const float pool = fractal_noise(p * 12.0f, 12, 4, 84), craze = std::abs(fractal_noise(p * 18.0f, 18, 4, 85));
    color *= 0.94f + 0.05f * unit(id) + 0.10f * pool;
    color *= 0.965f + 0.035f * glm::smoothstep(0.0f, 0.02f, craze);
    const float edge = 0.5f - std::max(exact.x, exact.y);
    const float solid = glm::smoothstep(0.006f, 0.011f, edge);
    const glm::vec3 grout = rgb(0x8c8475) * (0.95f + 0.4f * fractal_noise(p * 128.0f, 128, 3, 86));
    return {glm::mix(grout, color, solid), 0.004f * glm::smoothstep(0.004f, 0.022f, edge) + 0.0008f * pool};
}

// White marble: folded, domain-warped veins of two sizes, some of them golden.
Sample marble(glm::vec2 p) {
    const glm::vec2 fold = {fractal_noise(p * 3.0f, 3, 5, 91), fractal_noise(p * 3.0f, 3, 5, 92)};
    const glm::vec2 q = p + 0.34f * fold;
    const glm::vec2 fine = q + 0.10f * glm::vec2(fractal_noise(p * 8.0f, 8, 4, 93), fractal_noise(p * 8.0f, 8, 4, 94));
    const float cloud = 0.5f + fractal_noise(q * 4.0f, 4, 5, 95);
    const float large = std::abs(fractal_noise(q * 3.0f, 3, 4, 96)),
                small = std::abs(fractal_noise(fine * 8.0f, 8, 4, 97));
    glm::vec3 color = glm::mix(rgb(0xd9d8d6), rgb(0xf3f1ec), glm::smoothstep(0.2f, 0.9f, cloud));
    color = glm::mix(rgb(0x6d7078), color, glm::smoothstep(0.0f, 0.075f, large));
    color = glm::mix(rgb(0xa68a5b), color, 0.45f + 0.55f * glm::smoothstep(0.0f, 0.03f, small));
    color *= 0.985f + 0.05f * fractal_noise(p * 64.0f, 64, 3, 98);
    return {color, 0.0f};
}

// A plane's u picks the row of an image and its v the column. On a wall that faces z, u runs to the left and v down, so
// that a pattern with an upright stands there when its picture lies.
Picture laid_on_its_side(const Picture& picture) {
    Picture turned = picture;
    const auto side = static_cast<std::size_t>(picture.side);
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < side; ++column)
            std::copy_n(&picture.rgb[(column * side + side - 1 - row) * 3], 3, &turned.rgb[(row * side + column) * 3]);
    return turned;
}

}  // namespace

Picture texture(std::string_view name, int side) {
    Sample (*const sample)(glm::vec2) = name == "brick"    ? brick
                                        : name == "stone"  ? stone
                                        : name == "wood"   ? wood
                                        : name == "tiles"  ? tiles
                                        : name == "marble" ? marble
                                                           : nullptr;
    if (sample == nullptr) throw std::invalid_argument("no texture is called " + std::string(name));

    const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    const float step = 1.0f / static_cast<float>(side);
    std::vector<Sample> samples(pixels);
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t i = 0; i < pixels; ++i) samples[i] = sample((glm::vec2(i % side, i / side) + 0.5f) * step);

    Picture picture{side, std::vector<std::uint8_t>(pixels * 3)};
    const glm::vec3 light = glm::normalize(glm::vec3(-0.5f, -0.6f, 1.0f));  // baked in: from the upper left
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::size_t column = i % side, row = i / side;
        const float here = samples[i].height;
        const float right = samples[row * side + (column + 1) % side].height;
        const float below = samples[(row + 1) % side * side + column].height;
        const glm::vec3 normal = glm::normalize(glm::vec3((here - right) / step, (here - below) / step, 1.0f));
        const float lit = glm::dot(normal, light) / light.z;
        const glm::vec3 color = glm::clamp(samples[i].color * lit, 0.0f, 1.0f) * 255.0f + 0.5f;
        for (int channel = 0; channel < 3; ++channel)
            picture.rgb[i * 3 + channel] = static_cast<std::uint8_t>(color[channel]);
    }
    return name == "brick" ? laid_on_its_side(picture) : picture;
}

}  // namespace generate
