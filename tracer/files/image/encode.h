// Pictures are encoded by the helper programs (helper_process.h): none but PFM is written in this process. Samples
// stream to the helper row by row and the helper writes into the file itself, so neither process holds a picture twice.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "tracer/files/image/helper_process.h"

namespace raywalk {

struct ImageEncoding {
    ImageFormat format;
    int width, height;
    bool urgent;  // somebody waits: as fast as can be, however large
};

// The samples of rows [begin, end), 3 a pixel, row 0 on top: floats (EXR, TIFF, HDR) or bytes (PNG, JPEG). Called
// downwards, a few rows at a time; the memory may be used again by the next call.
using RowsOfSamples = std::function<std::span<const std::byte>(int begin, int end)>;

inline constexpr int rows_at_a_time = 64;
inline constexpr int encoded_file = 3;  // descriptor of the file in the helper

// Writes the encoded picture into `file`, a descriptor of an empty file. Returns the reason of a failure, empty on
// success. Throws WorkError when the helper cannot be run, and what `rows` throws.
std::string encode_in_process(const ImageEncoding& picture, const RowsOfSamples& rows, int file);

// What would keep a picture of this format from being encoded, as far as can be seen without encoding one; empty when
// nothing would.
std::string obstacle_to_encoding(ImageFormat format);

}  // namespace raywalk
