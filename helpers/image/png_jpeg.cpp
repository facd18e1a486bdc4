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

std::string encode_bytes(int width, int height, std::span<const std::uint8_t> rgb, std::vector<unsigned char>& bytes) {
    return encode_jpeg(width, height, rgb, bytes);
}

}  // namespace raywalk
