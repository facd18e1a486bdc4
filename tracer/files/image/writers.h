// The writers of each image format but JPEG. They throw WorkError, of the file.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/files/image/image.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {

void write_png(WholeFile& file, int width, int height, std::span<const std::uint8_t> rgb, Saving saving);

// 32-bit floats, lossless: ZIP (EXR), deflate with the predictor for floats (TIFF), or uncompressed where it is urgent.
void write_exr(WholeFile& file, const FloatRows& rows, Saving saving);
void write_tiff(WholeFile& file, const FloatRows& rows, Saving saving);
// Three bytes below a common exponent (Ward, Real Pixels, Graphics Gems II, 1991), each run-length coded.
void write_hdr(WholeFile& file, const FloatRows& rows);
// Portable float map: uncompressed.
void write_pfm(WholeFile& file, const FloatRows& rows);

}  // namespace raywalk
