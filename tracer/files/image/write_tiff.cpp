// TIFF 6.0, little-endian, in strips; floats and their predictor as in Adobe's Technical Note 3 (2005).
#include <algorithm>
#include <cstring>

#include "tracer/files/image/bands.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

namespace {

constexpr int strip_rows = 16;
enum Type : std::uint16_t { short_number = 3, long_number = 4, ratio = 5 };

// The directory of the picture, collected tag by tag in rising order.
class Directory {
  public:
    // `at`: where in the file the directory will be, and after it the values that are too long for it.
    Directory(std::uint64_t at, int tags) : values_at_(at + 2 + 12 * static_cast<std::uint64_t>(tags) + 4) {
        put_little_endian(entries_, static_cast<std::uint64_t>(tags), 2);
    }

    void add(std::uint16_t tag, Type type, const std::vector<std::uint64_t>& values) {
        std::string bytes;
        for (const std::uint64_t value : values) {
            put_little_endian(bytes, value, type == short_number ? 2 : 4);
            if (type == ratio) put_little_endian(bytes, 1, 4);
        }
        put_little_endian(entries_, tag, 2);
        put_little_endian(entries_, type, 2);
        put_little_endian(entries_, values.size(), 4);
        if (bytes.size() > 4) {
            put_little_endian(entries_, values_at_ + values_.size(), 4);
            values_ += bytes;
        } else {
            entries_ += bytes + std::string(4 - bytes.size(), '\0');
        }
    }
    [[nodiscard]] std::string bytes() const { return entries_ + std::string(4, '\0') + values_; }  // no next directory

  private:
    std::uint64_t values_at_;
    std::string entries_, values_;
};

// What is compressed of a row: the highest bytes of all floats, then the next ones, ..., each as the difference to the
// same byte of the pixel before.
void append_planes_of_differences(const float* row, std::size_t width, std::string& to) {
    const std::size_t count = width * 3, begin = to.size();
    to.resize(begin + count * sizeof(float));
    char* bytes = to.data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint32_t bits;
        std::memcpy(&bits, &row[i], sizeof bits);
        for (std::size_t plane = 0; plane < 4; ++plane)
            bytes[plane * count + i] = static_cast<char>(bits >> (24 - 8 * plane));
    }
    for (std::size_t i = count * sizeof(float); i-- > 3;) bytes[i] = static_cast<char>(bytes[i] - bytes[i - 3]);
}

}  // namespace

void write_tiff(WholeFile& file, const FloatRows& picture, Saving saving) {
    const bool compressed = saving != Saving::urgent;
    const auto width = static_cast<std::size_t>(picture.width);
    file.append(std::string_view("II*\0\0\0\0\0", 8));  // and where the directory is, which is known in the end

    const auto begins = append_bands(file, picture.height, strip_rows, [&](int begin, int end, std::string& bytes) {
        const std::span<const float> rgb = rows_of(picture, begin, end);
        if (!compressed) {
            bytes.append(reinterpret_cast<const char*>(rgb.data()), rgb.size() * sizeof(float));
            return;
        }
        std::string differences;
        differences.reserve(rgb.size() * sizeof(float));
        for (const float* row = rgb.data(); row != rgb.data() + rgb.size(); row += width * 3)
            append_planes_of_differences(row, width, differences);
        bytes = zlib_compressed(differences, 3);
    });

    const std::vector<std::uint64_t> offsets(begins.begin(), begins.end() - 1);
    std::vector<std::uint64_t> sizes;
    for (std::size_t i = 0; i < offsets.size(); ++i) sizes.push_back(begins[i + 1] - begins[i]);
    if (file.size() % 2 != 0) file.append(std::string_view("\0", 1));
    std::string place;
    put_little_endian(place, file.size(), 4);
    Directory directory(file.size(), compressed ? 15 : 14);
    directory.add(256, long_number, {width});
    directory.add(257, long_number, {static_cast<std::uint64_t>(picture.height)});
    directory.add(258, short_number, {32, 32, 32});                // bits of a channel
    directory.add(259, short_number, {compressed ? 8ull : 1ull});  // deflate, or none
    directory.add(262, short_number, {2});                         // RGB
    directory.add(273, long_number, offsets);
    directory.add(274, short_number, {1});  // from the top left
    directory.add(277, short_number, {3});  // channels
    directory.add(278, long_number, {strip_rows});
    directory.add(279, long_number, sizes);
    directory.add(282, ratio, {72});  // pixels across an inch, and down: required, and of no importance here
    directory.add(283, ratio, {72});
    directory.add(284, short_number, {1});                  // channels side by side
    if (compressed) directory.add(317, short_number, {3});  // differences of floats
    directory.add(339, short_number, {3, 3, 3});            // floats
    file.append(directory.bytes());
    file.overwrite(4, place);
}

}  // namespace raywalk
