#include <algorithm>
#include <cmath>

#include "tracer/files/image/extension.h"
#include "tracer/files/image/helper_process.h"
#include "tracer/files/image/image.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

const ImageExtension& require_extension(const fs::path& file) {
    if (const ImageExtension* extension = image_extension_of(file)) return *extension;
    throw WorkError("cannot write " + quoted_name(file.string()) +
                    ": its extension is none of .png .jpg .exr .pfm .hdr .tif");
}

// Who interrupted the program waits for its end, and a slow disk may take seconds for a large picture. Without waiting
// for it, a kill still leaves the old picture or the new one; a loss of power soon after may leave neither.
Durability durability_of(Saving saving) {
    return saving == Saving::urgent ? Durability::in_system : Durability::on_disk;
}

void write_jpeg(const fs::path& file, int width, int height, std::span<const std::uint8_t> rgb, Saving saving) {
    std::string problem;
    try {
        const std::string_view bytes(reinterpret_cast<const char*>(rgb.data()), rgb.size());
        const ImageResult result = encode_in_process(width, height, bytes);
        const bool replied = result.end.empty();
        if (replied && result.reply.status == ImageReply::done)
            return write_whole(file, result.body(), durability_of(saving));
        problem = replied ? printable(result.body()) : result.end;
    } catch (const WorkError& error) {
        problem = error.what();
        if (problem.starts_with("cannot write")) throw;
    }
    throw WorkError("cannot write " + quoted_name(file.string()) + ": " + problem);
}

std::uint8_t display_byte(float v) {
    return v > 0 ? static_cast<std::uint8_t>(std::lround(std::min(v, 1.0f) * 255.0f)) : std::uint8_t{0};
}

}  // namespace

void write_image(const fs::path& file, const FloatRows& picture, Saving saving) {
    const ImageExtension& extension = require_extension(file);
    if (!extension.floats) {
        std::vector<float> rgb(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) * 3);
        picture.read(0, picture.height, rgb.data());
        std::vector<std::uint8_t> bytes(rgb.size());
        std::ranges::transform(rgb, bytes.begin(), display_byte);
        return write_image(file, picture.width, picture.height, bytes, saving);
    }
    WholeFile whole(file);
    if (!extension.format)
        write_pfm(whole, picture);
    else if (*extension.format == ImageFormat::exr)
        write_exr(whole, picture, saving);
    else if (*extension.format == ImageFormat::tiff)
        write_tiff(whole, picture, saving);
    else
        write_hdr(whole, picture);
    whole.finish(durability_of(saving));
}

void write_image(const fs::path& file, const FloatImage& image, Saving saving) {
    const std::size_t row = static_cast<std::size_t>(image.width) * 3;
    const auto read = [&](int begin, int end, float* rgb) {
        std::copy_n(image.rgb.data() + static_cast<std::size_t>(begin) * row,
                    static_cast<std::size_t>(end - begin) * row, rgb);
    };
    write_image(file, FloatRows{image.width, image.height, read}, saving);
}

void write_image(const fs::path& file, int width, int height, std::span<const std::uint8_t> rgb, Saving saving) {
    const ImageExtension& extension = require_extension(file);
    if (extension.floats) {
        FloatImage image{width, height, std::vector<float>(rgb.size())};
        std::ranges::transform(rgb, image.rgb.begin(), [](std::uint8_t v) { return static_cast<float>(v) / 255.0f; });
        return write_image(file, image, saving);
    }
    if (*extension.format == ImageFormat::jpeg) return write_jpeg(file, width, height, rgb, saving);
    WholeFile whole(file);
    write_png(whole, width, height, rgb, saving);
    whole.finish(durability_of(saving));
}

}  // namespace raywalk
