// Which way up a picture is (TIFF 6.0, "Orientation"): 1 as stored; 2 mirrored, 3 turned by 180 degrees, 4 upside down,
// 5 rows and columns exchanged, 6 to be turned to the right, 7 exchanged and turned by 180 degrees, 8 to be turned
// left.
#pragma once

#include <cstddef>
#include <span>

#include "tracer/scene/image.h"

namespace raywalk {

// The orientation that Exif data say, beginning at their TIFF header; 1 where they say nothing that can be read.
int exif_orientation(std::span<const unsigned char> tiff);

// Brings row 0 to the top and column 0 to the left. An orientation that does not exist is 1.
void turn_upright(Image& image, int orientation);

}  // namespace raywalk
