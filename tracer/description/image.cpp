#include "tracer/description/image.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "tracer/description/image_codecs.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

// The module beside the program (as built), or in ../lib/raywalk (as installed).
ImageCodecs load_codecs() {
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
    std::string reason;
    for (const fs::path& folder : {here, here / "../lib/raywalk"}) {
        const fs::path module = folder / "raywalk_images.so";
        if (!fs::exists(module, error)) continue;
        void* handle = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (void* symbol = handle ? dlsym(handle, image_codecs_symbol) : nullptr)
            return std::bit_cast<ImageCodecsFunction>(symbol)();
        reason = dlerror();
    }
    if (reason.empty())
        reason = "raywalk_images.so is neither in " + here.string() + " nor in ../lib/raywalk from there";
    throw WorkError("images cannot be read or written: " + reason);
}

const ImageCodecs& codecs() {
    static const ImageCodecs loaded = load_codecs();  // once; a failure is tried again
    return loaded;
}

std::optional<ImageFormat> format_of(std::string_view bytes) {
    using namespace std::string_view_literals;
    constexpr std::pair<std::string_view, ImageFormat> beginnings[] = {
        {"\x89PNG\r\n\x1A\n"sv, ImageFormat::png},
        {"\xFF\xD8\xFF"sv, ImageFormat::jpeg},
        {"II*\0"sv, ImageFormat::tiff},
        {"MM\0*"sv, ImageFormat::tiff},
        {"II+\0"sv, ImageFormat::tiff},
        {"MM\0+"sv, ImageFormat::tiff},
        {"\x76\x2F\x31\x01"sv, ImageFormat::exr},
        {"#?RADIANCE"sv, ImageFormat::hdr},
        {"#?RGBE"sv, ImageFormat::hdr},
    };
    for (const auto& [beginning, format] : beginnings)
        if (bytes.starts_with(beginning)) return format;
    return std::nullopt;
}

// What a file of each extension holds. No format: PFM, which is written here.
struct Extension {
    std::string_view name;
    std::optional<ImageFormat> format;
    bool floats;
};
constexpr Extension extensions[] = {
    {".png", ImageFormat::png, false},  {".jpg", ImageFormat::jpeg, false}, {".jpeg", ImageFormat::jpeg, false},
    {".exr", ImageFormat::exr, true},   {".hdr", ImageFormat::hdr, true},   {".tif", ImageFormat::tiff, true},
    {".tiff", ImageFormat::tiff, true}, {".pfm", std::nullopt, true},
};

const Extension* extension_of(const fs::path& file) {
    std::string name = file.extension().string();
    std::ranges::transform(name, name.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const auto found = std::ranges::find(extensions, name, &Extension::name);
    return found == std::end(extensions) ? nullptr : found;
}

// Portable float map: rows bottom to top; the negative scale says little-endian.
std::vector<unsigned char> encode_pfm(const FloatImage& image) {
    static_assert(std::endian::native == std::endian::little);
    const std::string header = "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
    const std::size_t row = static_cast<std::size_t>(image.width) * 3 * sizeof(float);
    std::vector<unsigned char> bytes(header.size() + row * static_cast<std::size_t>(image.height));
    std::memcpy(bytes.data(), header.data(), header.size());
    unsigned char* to = bytes.data() + header.size();
    for (std::size_t y = static_cast<std::size_t>(image.height); y-- > 0; to += row)
        std::memcpy(to, image.rgb.data() + y * row / sizeof(float), row);
    return bytes;
}

std::vector<std::uint8_t> display_bytes(const FloatImage& image) {
    std::vector<std::uint8_t> bytes(image.rgb.size());
    std::ranges::transform(image.rgb, bytes.begin(), [](float v) {
        return v > 0 ? static_cast<std::uint8_t>(std::lround(std::min(v, 1.0f) * 255.0f)) : std::uint8_t{0};
    });
    return bytes;
}

const Extension& require_extension(const fs::path& file) {
    if (const Extension* extension = extension_of(file)) return *extension;
    throw WorkError("cannot write '" + file.string() + "': its extension is none of .png .jpg .exr .pfm .hdr .tif");
}

constexpr const char* readable_formats = "expected a PNG, JPEG, TIFF, EXR or HDR file";

InputError refusal(const fs::path& file, const SourceLocation& where, const std::string& problem, std::string advice) {
    const SourceLocation place = where.file.empty() ? SourceLocation{file.string()} : where;
    return InputError(error_at(place, "image " + raywalk::quoted(file.native()) + " " + problem, std::move(advice)));
}

void write_encoded(const fs::path& file, const std::string& problem, const std::vector<unsigned char>& bytes) {
    if (!problem.empty()) throw WorkError("cannot write '" + file.string() + "': " + problem);
    write_whole(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace

Image decode_image(std::string_view bytes, const fs::path& file, const Limits& limits, const SourceLocation& where) {
    const auto format = format_of(bytes);
    if (!format) throw refusal(file, where, "is none that a scene may show", readable_formats);
    std::string advice = "save it again with another program, or try another image";
    const auto size_problem = [&](std::uint64_t width, std::uint64_t height) -> std::string {
        const std::uint64_t pixels = width * height;  // each below 2^31
        const bool packed = pixels > (1ull << 22) + limits.image_pixels_per_byte * bytes.size();
        if (!packed && pixels <= limits.image_pixels) return {};
        advice = how_to_raise(limits, packed ? &Limits::image_pixels_per_byte : &Limits::image_pixels);
        return "it claims " + std::to_string(width) + " x " + std::to_string(height) + " pixels, " +
               (packed ? "more than so small a file can hold" : "which is too large");
    };
    Image image;
    const std::string problem = codecs().decode(*format, {bytes.data(), bytes.size()}, size_problem, image);
    if (!problem.empty()) throw refusal(file, where, "cannot be read: " + printable(problem), advice);
    return image;
}

Image read_image(const fs::path& file, const Limits& limits, const SourceLocation& where) {
    try {
        return decode_image(read_file_bytes(file, limits.image_bytes).text(), file, limits, where);
    } catch (const FileProblem& problem) {
        throw refusal(file, where, problem.what(),
                      problem.too_large ? how_to_raise(limits, &Limits::image_bytes) : readable_formats);
    }
}

bool is_image_extension(const fs::path& file) { return extension_of(file) != nullptr; }

bool is_float_extension(const fs::path& file) {
    const Extension* extension = extension_of(file);
    return extension && extension->floats;
}

void write_image(const fs::path& file, const FloatImage& image) {
    const Extension& extension = require_extension(file);
    if (!extension.format) return write_encoded(file, {}, encode_pfm(image));
    std::vector<unsigned char> bytes;
    const std::string problem =
        extension.floats
            ? codecs().encode_floats(*extension.format, image.width, image.height, image.rgb, bytes)
            : codecs().encode_bytes(*extension.format, image.width, image.height, display_bytes(image), bytes);
    write_encoded(file, problem, bytes);
}

void write_image(const fs::path& file, int width, int height, std::span<const std::uint8_t> rgb) {
    const Extension& extension = require_extension(file);
    if (extension.floats) {
        FloatImage image{width, height, std::vector<float>(rgb.size())};
        std::ranges::transform(rgb, image.rgb.begin(), [](std::uint8_t v) { return static_cast<float>(v) / 255.0f; });
        return write_image(file, image);
    }
    std::vector<unsigned char> bytes;
    const std::string problem = codecs().encode_bytes(*extension.format, width, height, rgb, bytes);
    write_encoded(file, problem, bytes);
}

}  // namespace raywalk
