#include "helpers/image/orientation.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace raywalk {

int exif_orientation(std::span<const unsigned char> tiff) {
    constexpr std::size_t header = 8, entry = 12;
    if (tiff.size() < header || tiff[0] != tiff[1] || (tiff[0] != 'I' && tiff[0] != 'M')) return 1;
    const bool big_endian = tiff[0] == 'M';
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | tiff[at + (big_endian ? i : bytes - 1 - i)];
        return value;
    };
    const std::size_t directory = number(4, 4);
    if (directory > tiff.size() - 2) return 1;
    const std::size_t count = number(directory, 2);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = directory + 2 + entry * i;
        if (at + entry > tiff.size()) return 1;
        constexpr std::size_t orientation = 0x0112, short_integer = 3;
        if (number(at, 2) == orientation && number(at + 2, 2) == short_integer)
            return static_cast<int>(number(at + 8, 2));
    }
    return 1;
}

void turn_upright(Image& image, int orientation) {
    if (orientation <= 1 || orientation > 8) return;
    const bool exchanged = orientation >= 5;
    const std::size_t width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
    // From the right end, from the lower end, as stored.
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    std::vector<std::uint32_t> texels(image.texels.size());
    const std::size_t columns = exchanged ? height : width, rows = exchanged ? width : height;
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t column = exchanged ? y : x, row = exchanged ? x : y;
            texels[y * columns + x] =
                image
                    .texels[(from_below ? height - 1 - row : row) * width + (from_right ? width - 1 - column : column)];
        }
    image.texels = std::move(texels);
    if (exchanged) std::swap(image.width, image.height);
}

}  // namespace raywalk
