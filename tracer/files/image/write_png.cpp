// PNG, 8-bit RGB. Bands are compressed apart from each other and joined to one zlib stream (RFC 1950, 1951).
#include <zlib.h>

#include <cstdlib>
#include <new>

#include "tracer/files/image/bands.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

namespace {

constexpr int band_rows = 64;

void append_chunk(std::string& to, const char* name, std::string_view data) {
    put_big_endian(to, data.size(), 4);
    const std::size_t begin = to.size();
    to.append(name, 4).append(data);
    put_big_endian(to, crc32_z(0, reinterpret_cast<const Bytef*>(&to[begin]), to.size() - begin), 4);
}

// Appends the differences of a row to another one, and returns the sum of their sizes.
std::uint32_t append_differences(const std::uint8_t* row, const std::uint8_t* other, std::size_t size,
                                 std::string& to) {
    const std::size_t begin = to.size();
    to.resize(begin + size);
    char* differences = &to[begin];
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
        differences[i] = static_cast<char>(row[i] - other[i]);
        sum += static_cast<std::uint32_t>(std::abs(static_cast<signed char>(differences[i])));
    }
    return sum;
}

// A row as differences to the pixels on the left or to those above, whatever are smaller.
void append_filtered(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::string& to) {
    constexpr char difference_to_left = 1, difference_to_above = 2;
    const std::size_t begin = to.size();
    to += difference_to_left;
    to.append(reinterpret_cast<const char*>(row), 3);
    const std::uint32_t of_left = append_differences(row + 3, row, size - 3, to);
    if (above == nullptr) return;
    const std::size_t end = to.size();
    if (append_differences(row, above, size, to) < of_left) {
        to[begin] = difference_to_above;
        to.erase(begin + 1, size);
    } else {
        to.resize(end);
    }
}

// A piece of a deflate stream that ends at a byte; the last piece ends the stream.
void append_deflated(std::string& data, bool urgent, bool last, std::string& to) {
    z_stream stream{};
    if (deflateInit2(&stream, urgent ? 1 : 3, Z_DEFLATED, -15, 9, urgent ? Z_RLE : Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    const std::size_t begin = to.size();
    try {
        to.resize(begin + deflateBound(&stream, data.size()) + 16);
    } catch (...) {
        deflateEnd(&stream);
        throw;
    }
    stream.next_in = reinterpret_cast<Bytef*>(data.data());
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(&to[begin]);
    stream.avail_out = static_cast<uInt>(to.size() - begin);
    deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
    to.resize(to.size() - stream.avail_out);
    deflateEnd(&stream);
}

}  // namespace

void write_png(WholeFile& file, int width, int height, std::span<const std::uint8_t> rgb, Saving saving) {
    std::string head = "\x89PNG\r\n\x1A\n", size;
    put_big_endian(size, static_cast<unsigned>(width), 4);
    put_big_endian(size, static_cast<unsigned>(height), 4);
    append_chunk(head, "IHDR", size + std::string("\x08\x02\0\0\0", 5));  // 8 bits, RGB
    append_chunk(head, "IDAT", "\x78\x01");                               // a zlib stream begins
    file.append(head);

    struct Sum {
        uLong adler = 1;
        z_off_t bytes = 0;
    };
    std::vector<Sum> sums(static_cast<std::size_t>((height + band_rows - 1) / band_rows));
    const std::size_t row_bytes = static_cast<std::size_t>(width) * 3;
    append_bands(file, height, band_rows, [&](int begin, int end, std::string& bytes) {
        thread_local std::string filtered, deflated;
        filtered.clear();
        deflated.clear();
        for (int y = begin; y < end; ++y) {
            const std::uint8_t* row = &rgb[static_cast<std::size_t>(y) * row_bytes];
            append_filtered(row, y > 0 ? row - row_bytes : nullptr, row_bytes, filtered);
        }
        sums[static_cast<std::size_t>(begin / band_rows)] = {
            adler32_z(1, reinterpret_cast<const Bytef*>(filtered.data()), filtered.size()),
            static_cast<z_off_t>(filtered.size())};
        append_deflated(filtered, saving == Saving::urgent, end == height, deflated);
        append_chunk(bytes, "IDAT", deflated);
    });

    Sum all;
    for (const Sum& sum : sums) all.adler = adler32_combine(all.adler, sum.adler, sum.bytes);
    std::string checksum, tail;
    put_big_endian(checksum, all.adler, 4);
    append_chunk(tail, "IDAT", checksum);
    append_chunk(tail, "IEND", {});
    file.append(tail);
}

}  // namespace raywalk
