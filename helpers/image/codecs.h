// Image formats: bytes in, bytes out. Used by the helper programs only (image_helper.cpp), which have one of two
// implementations: image_png_jpeg.cpp or image_openimageio.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tracer/files/image/helper_process.h"
#include "tracer/scene/image.h"

namespace raywalk {

// Says why an image of this size (pixels) is not wanted, before its pixels are read; empty when it is.
using ImageRefusal = std::function<std::string(std::uint64_t width, std::uint64_t height)>;

// Decodes `bytes` as `format`, and as nothing else: grey becomes RGB, alpha is dropped, values outside 0..1 are
// clamped and NaN is 0. Returns the reason of a failure, empty on success. Throws nothing but std::bad_alloc.
std::string decode_pixels(ImageFormat format, std::span<const char> bytes, const ImageRefusal& refusal, Image& image);

// Encodes `rgb`, 3 values a pixel, row 0 on top, as JPEG. Returns as decode_pixels does.
std::string encode_bytes(int width, int height, std::span<const std::uint8_t> rgb, std::vector<unsigned char>& bytes);

// Keeps the codecs to the calling thread.
void use_one_thread();

}  // namespace raywalk
