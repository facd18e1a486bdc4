// From a film to display values, for files and windows: round(255 clamp(mean * exposure)). On a graphics card
// shaders/resolve.frag does the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tracer/kernels/kernels.h"
#include "tracer/picture/film.h"

namespace raywalk {

// Words 0xffRRGGBB, rows from the top, of one tile into a picture of the film's size. Without a sample it is black.
void resolve_into(std::span<std::uint32_t> picture, const Film& film, int tile, const Kernels& kernels, float exposure);
// All tiles, on `threads` threads.
void resolve_into(std::span<std::uint32_t> picture, const Film& film, const Kernels& kernels, float exposure,
                  int threads);

// 3 bytes a pixel, red first, of words.
std::vector<std::uint8_t> rgb_bytes(std::span<const std::uint32_t> words);
// The same of a film.
std::vector<std::uint8_t> display_values(const Film& film, const Kernels& kernels, float exposure);

}  // namespace raywalk
