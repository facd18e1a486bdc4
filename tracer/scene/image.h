// Pictures in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace raywalk {

// 8-bit RGB, packed 0x00BBGGRR per texel (red in the lowest byte), row 0 on top.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint32_t> texels;
    std::uint32_t clipped = 0;  // texels of the file with a channel above 1, which became 1
};

// Linear RGB, 3 floats a pixel, row 0 on top.
struct FloatImage {
    int width = 0, height = 0;
    std::vector<float> rgb;
};

// A picture that is made row by row, when it is written: `read(begin, end, rgb)` fills `rgb` with the rows [begin,
// end), from several threads at once.
struct FloatRows {
    int width = 0, height = 0;
    std::function<void(int begin, int end, float* rgb)> read;
};

}  // namespace raywalk
