// Procedural, tileable pictures for planes and balls.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

namespace generate {

// 8-bit RGB, `side` x `side`, row 0 on top.
struct Picture {
    int side = 0;
    std::vector<std::uint8_t> rgb;
};

// Names: brick, stone, wood, tiles, marble. Throws std::invalid_argument for another.
Picture texture(std::string_view name, int side);

}  // namespace generate
