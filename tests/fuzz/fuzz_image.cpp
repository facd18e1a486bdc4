// PNG and JPEG, as the helper program decodes them. The formats that OpenImageIO reads are not fuzzed: what breaks
// there is not ours to mend, and ends with the helper (see helper_process.h).
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "helpers/image/codecs.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace raywalk;
    if (size == 0) return 0;
    const ImageRefusal refusal = [&](std::uint64_t width, std::uint64_t height) -> std::string {
        return width * height > (1 << 20) + 512 * size ? "too large" : "";
    };
    Image image;
    const auto format = data[0] == 0xFF ? ImageFormat::jpeg : ImageFormat::png;
    const std::string problem = decode_pixels(format, {reinterpret_cast<const char*>(data), size}, refusal, image);
    if (!problem.empty()) return 0;
    if (image.width < 1 || image.height < 1) std::abort();
    if (image.texels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        std::abort();
    for (const std::uint32_t texel : image.texels)
        if (texel > 0xFF'FFFF) std::abort();
    return 0;
}
