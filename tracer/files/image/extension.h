// What the extension of an image file says it holds.
#pragma once

#include <filesystem>
#include <optional>

#include "tracer/files/image/helper_process.h"

namespace raywalk {

// What a file of each extension holds. No format: PFM, which is only written.
struct ImageExtension {
    std::string_view name;
    std::optional<ImageFormat> format;
    bool floats;  // linear radiance, else 8-bit display values
};

// nullptr for other extensions. Upper case is lower case.
const ImageExtension* image_extension_of(const std::filesystem::path& file);

}  // namespace raywalk
