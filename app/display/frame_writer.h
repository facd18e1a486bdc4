// The film as a frame: straight into the memory that the device copies from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/display/frame_exchange.h"
#include "tracer/kernels/kernels.h"
#include "tracer/picture/film.h"

namespace raywalk {

// Resolves one tile of the film into a picture of the film's size.
void resolve_into(std::span<std::uint32_t> picture, const Film& film, int tile, const Kernels& kernels, float exposure);
// All of them, on `threads` threads. Tiles without a sample are black.
void resolve_into(std::span<std::uint32_t> picture, const Film& film, const Kernels& kernels, float exposure,
                  int threads);

// Writes the film to the next slot and publishes it. `info` says everything but size and content.
void publish_film(FrameExchange& exchange, FrameContent content, FrameInfo info, const Film& film,
                  const Kernels& kernels, float exposure, int threads);
// The same for a picture that is resolved already: width * height words.
void publish_picture(FrameExchange& exchange, FrameInfo info, int width, int height,
                     std::span<const std::uint32_t> picture);

// The picture at another size, bilinearly, pixel centres on pixel centres, the edge continued: as shaders/scale.frag
// shows a small frame.
void upscale(std::span<const std::uint32_t> from, int from_width, int from_height, std::span<std::uint32_t> to,
             int to_width, int to_height);

}  // namespace raywalk
