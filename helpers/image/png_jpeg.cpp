// The codecs of the program raywalk_png_jpeg, which starts at once: the formats that most pictures have.
#include "helpers/image/codecs.h"
#include "helpers/image/jpeg.h"
#include "helpers/image/png.h"

namespace raywalk {

namespace {
constexpr const char* neither = "it is neither PNG nor JPEG";
}

void use_one_thread() {}  // it has no other

std::string decode_pixels(ImageFormat format, std::span<const char> bytes, const ImageRefusal& refusal, Image& image) {
    if (format == ImageFormat::png) return decode_png(bytes, refusal, image);
    return format == ImageFormat::jpeg ? decode_jpeg(bytes, refusal, image) : neither;
}

std::string encode_picture(const ImageEncoding& picture, const NextRows& next, EncodedFile& file) {
    if (picture.format == ImageFormat::png) return encode_png(picture, next, file);
    return picture.format == ImageFormat::jpeg ? encode_jpeg(picture, next, file) : neither;
}

}  // namespace raywalk
