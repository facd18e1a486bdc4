// What the writers of image files share: a picture is encoded in bands of rows, by all threads, each band as it is
// needed. So there is no second copy of a picture, whose memory takes longer to get than to fill.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/files/image/image.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {

// Appends rows [begin, end), encoded, to `bytes`. Called by several threads at once, each with another band.
using EncodeBand = std::function<void(int begin, int end, std::string& bytes)>;

// Appends the bands of `rows` rows each (the last may have fewer) to the file, in order. Returns where each begins in
// the file, and at last where the last one ends.
std::vector<std::uint64_t> append_bands(WholeFile& file, int height, int rows, const EncodeBand& encode);

// Rows [begin, end) of a picture, in memory that the calling thread's next call uses again.
std::span<const float> rows_of(const FloatRows& picture, int begin, int end);

// `data` as a zlib stream; level 1 (fast) to 9 (small).
std::string zlib_compressed(std::string_view data, int level);

// Appends the `bytes` lowest bytes of a number.
void put_little_endian(std::string& to, std::uint64_t value, int bytes);
void put_big_endian(std::string& to, std::uint64_t value, int bytes);

}  // namespace raywalk
