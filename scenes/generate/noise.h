// Seamless noise: everything repeats with the given whole period, so that textures tile.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace generate {

// A well-mixed value of three whole numbers.
std::uint32_t hash(int x, int y, std::uint32_t seed);
// The same as a number in [0, 1).
float hash_unit(int x, int y, std::uint32_t seed);

// Gradient noise (Perlin 1985, quintic fade of Perlin 2002), about -1..1; cells of side 1, repeating every `period`.
float gradient_noise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed);
inline float gradient_noise(glm::vec2 p, int period, std::uint32_t seed) {
    return gradient_noise(p, glm::ivec2(period), seed);
}

// Octaves of gradient noise, each twice as fine and half as strong; about -1..1.
float fractal_noise(glm::vec2 p, glm::ivec2 period, int octaves, std::uint32_t seed);
inline float fractal_noise(glm::vec2 p, int period, int octaves, std::uint32_t seed) {
    return fractal_noise(p, glm::ivec2(period), octaves, seed);
}

// Cellular noise (Worley 1996) with one jittered point a cell.
struct Cell {
    float border;      // distance to the border between the nearest two cells
    std::uint32_t id;  // of the nearest cell
};
Cell cellular_noise(glm::vec2 p, int period, float jitter, std::uint32_t seed);

}  // namespace generate
