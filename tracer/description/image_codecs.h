// The door between the tracer and the module that holds OpenImageIO (raywalk_images.so). Bytes in, bytes out: files
// are opened, checked and replaced on the tracer's side.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tracer/description/image.h"

namespace raywalk {

enum class ImageFormat { png, jpeg, tiff, exr, hdr };

struct ImageCodecs {
    // Says why an image of this size (pixels) is not wanted, before its pixels are read; empty when it is.
    using Refusal = std::function<std::string(std::uint64_t width, std::uint64_t height)>;

    // Decodes `bytes` as `format`, and as nothing else: grey becomes RGB, alpha is dropped, values outside 0..1 are
    // clamped and NaN is 0. Returns the reason of a failure, empty on success. Never throws but std::bad_alloc.
    std::string (*decode)(ImageFormat format, std::span<const char> bytes, const Refusal& refusal, Image& image);

    // Encodes `rgb`, 3 values a pixel, row 0 on top: floats for TIFF (32 bit), EXR (32 bit, lossless) and HDR, bytes
    // for PNG and JPEG. Returns as decode does.
    std::string (*encode_floats)(ImageFormat format, int width, int height, std::span<const float> rgb,
                                 std::vector<unsigned char>& bytes);
    std::string (*encode_bytes)(ImageFormat format, int width, int height, std::span<const std::uint8_t> rgb,
                                std::vector<unsigned char>& bytes);
};

// What the module exports under this name.
inline constexpr const char* image_codecs_symbol = "raywalk_image_codecs";
using ImageCodecsFunction = ImageCodecs (*)();

}  // namespace raywalk
