// PNG by libpng; see image_codecs.h for what the functions promise.
#pragma once

#include "helpers/image/codecs.h"

namespace raywalk {

std::string decode_png(std::span<const char> bytes, const ImageRefusal& refusal, Image& image);
// 8-bit RGB.
std::string encode_png(const ImageEncoding& picture, const NextRows& next, EncodedFile& file);

}  // namespace raywalk
