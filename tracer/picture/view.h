// What is looked at, and how: all that the accumulated picture depends on.
#pragma once

#include <cstdint>

#include "tracer/picture/camera.h"

namespace raywalk {

// What a picture is made with besides camera and size.
struct SampleSettings {
    std::uint32_t seed = 0;
    bool one_shot = true;  // true: one sample a pixel is all there will be, so every point of an area light is used
    friend bool operator==(const SampleSettings&, const SampleSettings&) = default;
};

// Everything the accumulated picture depends on; compared by value.
struct View {
    Camera camera;
    int width = 0, height = 0;
    SampleSettings settings;
    friend bool operator==(const View&, const View&) = default;
};

}  // namespace raywalk
