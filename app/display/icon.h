// The window's icon: a mirrored ball over a floor of squares, drawn here rather than read from a file.
#pragma once

#include <cstdint>
#include <vector>

namespace raywalk {

// side * side pixels of R G B A bytes, rows from the top; straight alpha.
std::vector<std::uint8_t> icon_pixels(int side);

}  // namespace raywalk
