// The film as a frame: straight into the memory that the device copies from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/display/frame_exchange.h"
#include "tracer/kernels/kernels.h"
#include "tracer/picture/film.h"

namespace raywalk {

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
