#include "app/display/frame_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tracer/rendering/resolve.h"

namespace raywalk {
namespace {

// The last sample position left of or at an output pixel's centre, and the weight of the next one in 256ths.
struct Tap {
    int first, second, weight;
};

std::vector<Tap> taps_of(int from, int to) {
    std::vector<Tap> taps(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        const double at = (i + 0.5) * from / to - 0.5;
        const double before = std::floor(at);
        taps[i] = {std::clamp(static_cast<int>(before), 0, from - 1),
                   std::clamp(static_cast<int>(before) + 1, 0, from - 1),
                   static_cast<int>(std::lround((at - before) * 256))};
    }
    return taps;
}

// a + (b - a) * weight / 256 in each of the four bytes; two bytes at a time, eight bits apart.
std::uint32_t mix(std::uint32_t a, std::uint32_t b, std::uint32_t weight) {
    constexpr std::uint32_t even = 0x00ff00ff, half = 0x00800080;
    const std::uint32_t low = ((a & even) * (256 - weight) + (b & even) * weight + half) >> 8 & even;
    const std::uint32_t high = ((a >> 8 & even) * (256 - weight) + (b >> 8 & even) * weight + half) & ~even;
    return low | high;
}

}  // namespace

void publish_film(FrameExchange& exchange, FrameContent content, FrameInfo info, const Film& film,
                  const Kernels& kernels, float exposure, int threads) {
    info.width = film.width;
    info.height = film.height;
    info.content = content;
    if (content == FrameContent::display) {
        const std::size_t pixels = static_cast<std::size_t>(film.width) * film.height;
        FrameSlot& slot = exchange.begin_write(pixels * sizeof(std::uint32_t));
        resolve_into({reinterpret_cast<std::uint32_t*>(slot.data), pixels}, film, kernels, exposure, threads);
        slot.info = info;
    } else {
        const std::size_t tile_bytes = film.tiles.size() * sizeof(FilmTile);
        FrameSlot& slot = exchange.begin_write(tile_bytes + film.tiles.size() * sizeof(float));
        auto* tiles = reinterpret_cast<FilmTile*>(slot.data);
        auto* scales = reinterpret_cast<float*>(slot.data + tile_bytes);
        for (std::size_t tile = 0; tile < film.tiles.size(); ++tile) {
            // The sums of a tile that has no sample yet are those of an older picture.
            tiles[tile] = film.samples[tile] > 0 ? film.tiles[tile] : FilmTile{};
            scales[tile] = film_scale(exposure, film.samples[tile]);
        }
        slot.info = info;
    }
    exchange.publish();
}

void publish_picture(FrameExchange& exchange, FrameInfo info, int width, int height,
                     std::span<const std::uint32_t> picture) {
    FrameSlot& slot = exchange.begin_write(picture.size_bytes());
    std::memcpy(slot.data, picture.data(), picture.size_bytes());
    info.width = width;
    info.height = height;
    info.content = FrameContent::display;
    slot.info = info;
    exchange.publish();
}

void upscale(std::span<const std::uint32_t> from, int from_width, int from_height, std::span<std::uint32_t> to,
             int to_width, int to_height) {
    const std::vector<Tap> columns = taps_of(from_width, to_width), rows = taps_of(from_height, to_height);
    std::vector<std::uint32_t> line(static_cast<std::size_t>(from_width));
    for (int y = 0; y < to_height; ++y) {
        const std::uint32_t* above = &from[static_cast<std::size_t>(rows[y].first) * from_width];
        const std::uint32_t* below = &from[static_cast<std::size_t>(rows[y].second) * from_width];
        const auto weight = static_cast<std::uint32_t>(rows[y].weight);
        for (int x = 0; x < from_width; ++x) line[x] = mix(above[x], below[x], weight);
        std::uint32_t* out = &to[static_cast<std::size_t>(y) * to_width];
        for (int x = 0; x < to_width; ++x)
            out[x] =
                mix(line[columns[x].first], line[columns[x].second], static_cast<std::uint32_t>(columns[x].weight));
    }
}

}  // namespace raywalk
