#include "tracer/files/image/extension.h"

#include <algorithm>
#include <string>

#include "tracer/files/image/image.h"

namespace raywalk {

namespace {

constexpr ImageExtension extensions[] = {
    {".png", ImageFormat::png, false},  {".jpg", ImageFormat::jpeg, false}, {".jpeg", ImageFormat::jpeg, false},
    {".exr", ImageFormat::exr, true},   {".hdr", ImageFormat::hdr, true},   {".tif", ImageFormat::tiff, true},
    {".tiff", ImageFormat::tiff, true}, {".pfm", std::nullopt, true},
};

}  // namespace

const ImageExtension* image_extension_of(const std::filesystem::path& file) {
    std::string name = file.extension().string();
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const auto found = std::ranges::find(extensions, name, &ImageExtension::name);
    return found == std::end(extensions) ? nullptr : found;
}

bool is_image_extension(const std::filesystem::path& file) { return image_extension_of(file) != nullptr; }

bool is_float_extension(const std::filesystem::path& file) {
    const ImageExtension* extension = image_extension_of(file);
    return extension && extension->floats;
}

}  // namespace raywalk
