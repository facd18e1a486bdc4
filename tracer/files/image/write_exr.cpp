// OpenEXR, one part, scan lines: as "OpenEXR File Layout" of its documentation describes it.
#include <algorithm>
#include <cstring>

#include "tracer/files/image/bands.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

namespace {

enum Compression : char { none = 0, zip = 3 };
constexpr int zip_rows = 16;  // of a block; an uncompressed one has one row

void put_float(std::string& to, float value) { to.append(reinterpret_cast<const char*>(&value), sizeof value); }

void put_attribute(std::string& to, const char* name, const char* type, const std::string& value) {
    to.append(name).push_back('\0');
    to.append(type).push_back('\0');
    put_little_endian(to, value.size(), 4);
    to += value;
}

std::string header(int width, int height, Compression compression) {
    std::string channels, window, numbers;
    for (const char* name : {"B", "G", "R"}) {
        channels.append(name).push_back('\0');
        for (const std::uint64_t value : {2, 0, 1, 1}) put_little_endian(channels, value, 4);  // floats, every pixel
    }
    channels += '\0';
    for (const int value : {0, 0, width - 1, height - 1}) put_little_endian(window, static_cast<unsigned>(value), 4);
    put_float(numbers, 1);

    std::string bytes;
    put_little_endian(bytes, 20000630, 4);  // what an EXR file begins with
    put_little_endian(bytes, 2, 4);         // version
    put_attribute(bytes, "channels", "chlist", channels);
    put_attribute(bytes, "compression", "compression", std::string(1, compression));
    put_attribute(bytes, "dataWindow", "box2i", window);
    put_attribute(bytes, "displayWindow", "box2i", window);
    put_attribute(bytes, "lineOrder", "lineOrder", std::string(1, '\0'));  // downwards
    put_attribute(bytes, "pixelAspectRatio", "float", numbers);
    put_attribute(bytes, "screenWindowCenter", "v2f", std::string(8, '\0'));
    put_attribute(bytes, "screenWindowWidth", "float", numbers);
    return bytes + '\0';
}

// Rows of pixels as EXR has them: of each row all blues, then all greens, then all reds.
std::string planes(const float* rgb, std::size_t width, std::size_t rows) {
    std::string bytes(rows * width * 3 * sizeof(float), '\0');
    char* to = bytes.data();
    for (const float* row = rgb; row != rgb + rows * width * 3; row += width * 3)
        for (const std::size_t channel : {2, 1, 0})
            for (std::size_t x = 0; x < width; ++x, to += sizeof(float))
                std::memcpy(to, &row[x * 3 + channel], sizeof(float));
    return bytes;
}

// What ZIP compresses: the bytes at even places, then the others, each as the difference to the one before.
std::string differences(std::string_view bytes) {
    std::string result(bytes.size(), '\0');
    const std::size_t half = (bytes.size() + 1) / 2;
    for (std::size_t i = 0; i < bytes.size(); ++i) result[i / 2 + (i % 2) * half] = bytes[i];
    for (std::size_t i = result.size(); i-- > 1;) result[i] = static_cast<char>(result[i] - result[i - 1] + 128);
    return result;
}

}  // namespace

void write_exr(WholeFile& file, const FloatRows& picture, Saving saving) {
    const Compression compression = saving == Saving::urgent ? none : zip;
    const int block_rows = compression == zip ? zip_rows : 1;
    file.append(header(picture.width, picture.height, compression));

    // Where each block begins, which is known in the end.
    const std::uint64_t table_at = file.size();
    const int blocks = (picture.height + block_rows - 1) / block_rows;
    file.append(std::string(static_cast<std::size_t>(blocks) * 8, '\0'));
    std::vector<std::uint32_t> sizes(static_cast<std::size_t>(blocks));

    const auto width = static_cast<std::size_t>(picture.width);
    const auto begins = append_bands(file, picture.height, zip_rows, [&](int begin, int end, std::string& bytes) {
        const std::span<const float> rgb = rows_of(picture, begin, end);
        for (int y = begin; y < end; y += block_rows) {
            const int rows = std::min(block_rows, end - y);
            std::string block =
                planes(&rgb[static_cast<std::size_t>(y - begin) * width * 3], width, static_cast<std::size_t>(rows));
            if (compression == zip) {
                std::string packed = zlib_compressed(differences(block), 3);
                if (packed.size() < block.size()) block = std::move(packed);  // readers tell by the size
            }
            put_little_endian(bytes, static_cast<unsigned>(y), 4);
            put_little_endian(bytes, block.size(), 4);
            bytes += block;
            sizes[static_cast<std::size_t>(y / block_rows)] = static_cast<std::uint32_t>(block.size());
        }
    });

    std::string table;
    std::uint64_t at = begins.front();
    for (const std::uint32_t size : sizes) {
        put_little_endian(table, at, 8);
        at += 8 + size;
    }
    file.overwrite(table_at, table);
}

}  // namespace raywalk
