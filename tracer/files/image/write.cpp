#include <algorithm>
#include <bit>
#include <cmath>

#include "tracer/files/image/encode.h"
#include "tracer/files/image/extension.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/whole_file.h"

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

std::uint8_t display_byte(float v) {
    return v > 0 ? static_cast<std::uint8_t>(std::lround(std::min(v, 1.0f) * 255.0f)) : std::uint8_t{0};
}

std::size_t values_of(int width, int rows) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(rows) * 3;
}

// Rows of floats, in memory that each call uses again.
auto floats_of(const FloatRows& picture) {
    return [&picture, rgb = std::vector<float>()](int begin, int end) mutable -> std::span<const float> {
        rgb.resize(values_of(picture.width, end - begin));
        picture.read(begin, end, rgb.data());
        return rgb;
    };
}

// Portable float map: uncompressed, from the bottom row.
void write_pfm(WholeFile& file, const FloatRows& picture) {
    static_assert(std::endian::native == std::endian::little);  // as the negative scale says
    file.append("PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n");
    auto floats = floats_of(picture);
    const std::size_t row_values = values_of(picture.width, 1);
    for (int end = picture.height; end > 0; end -= rows_at_a_time) {
        const int begin = std::max(end - rows_at_a_time, 0);
        const std::span<const float> rgb = floats(begin, end);
        std::string bytes;
        bytes.reserve(rgb.size_bytes());
        for (auto row = static_cast<std::size_t>(end - begin); row-- > 0;)
            bytes.append(reinterpret_cast<const char*>(&rgb[row * row_values]), row_values * sizeof(float));
        file.append(bytes);
    }
}

void write_encoded(const fs::path& file, const ImageEncoding& picture, const RowsOfSamples& rows) {
    WholeFile whole(file);
    std::string problem;
    try {
        problem = encode_in_process(picture, rows, whole.descriptor());
    } catch (const WorkError& error) {
        problem = error.what();
    }
    if (!problem.empty()) throw WorkError("cannot write " + quoted_name(file.string()) + ": " + printable(problem));
    whole.finish(durability_of(picture.urgent ? Saving::urgent : Saving::unhurried));
}

}  // namespace

void write_image(const fs::path& file, const FloatRows& picture, Saving saving) {
    const ImageExtension& extension = require_extension(file);
    if (!extension.format) {
        WholeFile whole(file);
        write_pfm(whole, picture);
        return whole.finish(durability_of(saving));
    }
    const ImageEncoding encoding{*extension.format, picture.width, picture.height, saving == Saving::urgent};
    auto floats = floats_of(picture);
    if (extension.floats)
        return write_encoded(file, encoding, [&](int begin, int end) { return std::as_bytes(floats(begin, end)); });
    std::vector<std::uint8_t> bytes;
    write_encoded(file, encoding, [&](int begin, int end) {
        const std::span<const float> rgb = floats(begin, end);
        bytes.resize(rgb.size());
        std::ranges::transform(rgb, bytes.begin(), display_byte);
        return std::as_bytes(std::span(bytes));
    });
}

void write_image(const fs::path& file, const FloatImage& image, Saving saving) {
    const auto read = [&](int begin, int end, float* rgb) {
        std::copy_n(image.rgb.data() + values_of(image.width, begin), values_of(image.width, end - begin), rgb);
    };
    write_image(file, FloatRows{image.width, image.height, read}, saving);
}

void write_image(const fs::path& file, int width, int height, std::span<const std::uint8_t> rgb, Saving saving) {
    const ImageExtension& extension = require_extension(file);
    const auto rows = [&](int begin, int end) {
        return rgb.subspan(values_of(width, begin), values_of(width, end - begin));
    };
    if (extension.floats) {
        const auto read = [&](int begin, int end, float* floats) {
            std::ranges::transform(rows(begin, end), floats,
                                   [](std::uint8_t v) { return static_cast<float>(v) / 255; });
        };
        return write_image(file, FloatRows{width, height, read}, saving);
    }
    write_encoded(file, {*extension.format, width, height, saving == Saving::urgent},
                  [&](int begin, int end) { return std::as_bytes(rows(begin, end)); });
}

std::string obstacle_to_writing_image(const fs::path& file) {
    if (std::string obstacle = obstacle_to_writing(file); !obstacle.empty()) return obstacle;
    const ImageExtension* extension = image_extension_of(file);
    return extension && extension->format ? obstacle_to_encoding(*extension->format) : std::string();
}

}  // namespace raywalk
