// Pictures are decoded by a helper program, run once for each: what a hostile picture does to a decoder (a
// crash, a hang, gigabytes) ends there, within limits, as a message. There are two. raywalk_png_jpeg starts in a
// millisecond or two; raywalk_openimageio, for the other formats, brings OpenImageIO's 260 libraries along, which takes
// 0.2-0.35 s and would be part of every start if the tracer itself were linked with them. Pictures are encoded there
// too, by the same libraries (image_encode.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/ground/file_bytes.h"

namespace raywalk {

enum class ImageFormat { png, jpeg, tiff, exr, hdr };

// Memory of the helper for each pixel that a picture claims: decoders hold it in the file's own precision (up to 4
// channels of 4 bytes) and as a texel, and some of them more than once.
inline constexpr std::uint64_t memory_of_a_pixel = 24;

// What the helper may take for one picture.
struct ImageBudget {
    std::uint64_t pixels = 0;        // more in the header: refused
    std::uint64_t memory_bytes = 0;  // data of the process, beside that for pixels; 0: no limit
    std::uint64_t output_bytes = 0;  // 0: no limit
    std::uint64_t seconds = 0;       // of CPU time; 0: no limit
};

// What the helper's output begins with; texels or encoded bytes follow, or, after a failure, its reason as text.
struct ImageReply {
    static constexpr std::uint32_t magic_number = 0x5741'5952;
    enum Status : std::uint32_t { done, failed, too_large };
    std::uint32_t magic = 0;
    Status status = failed;
    std::uint32_t width = 0, height = 0;  // of the picture, done or too large
    std::uint32_t clipped = 0;            // Image::clipped
};

struct ImageResult {
    ImageReply reply;  // magic checked, nothing else: a decoder that was taken over can say anything
    FileBytes output;  // the reply included
    std::string end;   // how the helper ended, when it broke over this picture: there is no reply then
    [[nodiscard]] std::string_view body() const { return output.text().substr(sizeof(ImageReply)); }
};

// Runs the helper on `input`. Throws WorkError when it cannot be run, which is no fault of the picture.
ImageResult decode_in_process(ImageFormat format, std::string_view input, const ImageBudget& budget);

}  // namespace raywalk
