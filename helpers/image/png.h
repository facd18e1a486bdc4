// PNG, read by libpng; see image_codecs.h for what the functions promise.
#pragma once

#include "helpers/image/codecs.h"

namespace raywalk {

std::string decode_png(std::span<const char> bytes, const ImageRefusal& refusal, Image& image);

}  // namespace raywalk
