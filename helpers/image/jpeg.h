// JPEG by libjpeg-turbo; see image_codecs.h for what the functions promise.
#pragma once

#include "helpers/image/codecs.h"

namespace raywalk {

std::string decode_jpeg(std::span<const char> bytes, const ImageRefusal& refusal, Image& image);
// Quality 95, colours at full resolution.
std::string encode_jpeg(const ImageEncoding& picture, const NextRows& next, EncodedFile& file);

}  // namespace raywalk
