#include <algorithm>
#include <cmath>

#include "tracer/files/image/bands.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

namespace {

constexpr float largest_value = 0x1.FFFFFEp126f;  // has the largest exponent, 127, that a byte holds with 128 added
constexpr std::size_t least_run = 4;              // a shorter one is not worth its own two bytes
constexpr std::size_t longest_run = 127;          // of one value
constexpr std::size_t longest_literal = 128;      // values as they are

// Red, green, blue and exponent; NaN and what is negative is 0.
void put_pixel(const float* rgb, unsigned char* rgbe, std::size_t stride) {
    float channels[3];
    for (int c = 0; c < 3; ++c) channels[c] = rgb[c] > 0 ? std::min(rgb[c], largest_value) : 0.0f;
    const float largest = std::max({channels[0], channels[1], channels[2]});
    int exponent = 0;
    const bool black = largest < 1e-32f;
    if (!black) std::frexp(largest, &exponent);
    for (std::size_t c = 0; c < 3; ++c)
        rgbe[c * stride] = black ? 0 : static_cast<unsigned char>(std::ldexp(channels[c], 8 - exponent));
    rgbe[3 * stride] = black ? 0 : static_cast<unsigned char>(exponent + 128);
}

std::size_t run_length(const unsigned char* begin, const unsigned char* end) {
    const unsigned char* at = begin;
    while (at != end && *at == *begin) ++at;
    return static_cast<std::size_t>(at - begin);
}

void put_literals(const unsigned char* begin, const unsigned char* end, std::string& bytes) {
    while (begin != end) {
        const auto count = std::min(static_cast<std::size_t>(end - begin), longest_literal);
        bytes += static_cast<char>(count);
        bytes.append(reinterpret_cast<const char*>(begin), count);
        begin += count;
    }
}

void put_runs(const unsigned char* begin, const unsigned char* end, std::string& bytes) {
    const unsigned char* literals = begin;
    while (begin != end) {
        const std::size_t equal = run_length(begin, end);
        if (equal >= least_run) {
            put_literals(literals, begin, bytes);
            for (std::size_t left = equal; left > 0; left -= std::min(left, longest_run)) {
                bytes += static_cast<char>(128 + std::min(left, longest_run));
                bytes += static_cast<char>(*begin);
            }
            literals = begin + equal;
        }
        begin += equal;
    }
    put_literals(literals, end, bytes);
}

}  // namespace

void write_hdr(WholeFile& file, const FloatRows& picture) {
    file.append("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(picture.height) + " +X " +
                std::to_string(picture.width) + "\n");
    const auto width = static_cast<std::size_t>(picture.width);
    const bool runs = width >= 8 && width <= 0x7FFF;  // readers take other rows for pixels
    append_bands(file, picture.height, 64, [&](int begin, int end, std::string& bytes) {
        const std::span<const float> rgb = rows_of(picture, begin, end);
        thread_local std::vector<unsigned char> row;
        row.resize(width * 4);
        for (const float* pixels = rgb.data(); pixels != rgb.data() + rgb.size(); pixels += width * 3) {
            // With runs the row holds all reds, then all greens, ...; without, pixel by pixel.
            const std::size_t step = runs ? 1 : 4, stride = runs ? width : 1;
            for (std::size_t x = 0; x < width; ++x) put_pixel(pixels + x * 3, row.data() + x * step, stride);
            if (!runs) {
                bytes.append(reinterpret_cast<const char*>(row.data()), row.size());
                continue;
            }
            bytes += "\x02\x02";
            put_big_endian(bytes, width, 2);
            for (std::size_t c = 0; c < 4; ++c) put_runs(&row[c * width], row.data() + (c + 1) * width, bytes);
        }
    });
}

}  // namespace raywalk
