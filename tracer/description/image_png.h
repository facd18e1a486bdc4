// PNG by libpng; see image_codecs.h for what the functions promise.
#pragma once

#include "tracer/description/image_codecs.h"

namespace raywalk {

std::string decode_png(std::span<const char> bytes, const ImageRefusal& refusal, Image& image);
std::string encode_png(int width, int height, std::span<const std::uint8_t> rgb, std::vector<unsigned char>& bytes);

}  // namespace raywalk
