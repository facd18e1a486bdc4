#include <bit>

#include "tracer/files/image/bands.h"
#include "tracer/files/image/writers.h"

namespace raywalk {

void write_pfm(WholeFile& file, const FloatRows& picture) {
    static_assert(std::endian::native == std::endian::little);  // as the negative scale says
    file.append("PF\n" + std::to_string(picture.width) + " " + std::to_string(picture.height) + "\n-1.0\n");
    const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * 3 * sizeof(float);
    const int height = picture.height;
    append_bands(file, height, 64, [&](int begin, int end, std::string& bytes) {  // from the bottom row
        const std::span<const float> rgb = rows_of(picture, height - end, height - begin);
        for (auto row = static_cast<std::size_t>(end - begin); row-- > 0;)
            bytes.append(reinterpret_cast<const char*>(rgb.data()) + row * row_bytes, row_bytes);
    });
}

}  // namespace raywalk
