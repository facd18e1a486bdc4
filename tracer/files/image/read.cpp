#include "tracer/files/image/image.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "tracer/files/image/helper_process.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

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

constexpr const char* readable_formats = "expected a PNG, JPEG, TIFF, EXR or HDR file";

constexpr const char* other_image = "save it again with another program, or try another image";
constexpr std::uint64_t small_image = 1ull << 22;  // pixels that any file may promise

InputError refusal(const fs::path& file, const SourceLocation& where, const std::string& problem, std::string advice) {
    const SourceLocation place = where.file.empty() ? SourceLocation{file.string()} : where;
    return InputError(error_at(place, "image " + raywalk::quoted(file.native()) + " " + problem, std::move(advice)));
}

// What decoding may cost, for a picture of at most so many pixels. Decoders hold the file; the rest of the memory is
// what a process of so many libraries needs itself.
ImageBudget budget_for(std::uint64_t pixels, std::uint64_t file_bytes, const Limits& limits) {
    return {.pixels = pixels,
            .memory_bytes = (80ull << 20) + 2 * file_bytes,
            .output_bytes = sizeof(ImageReply) + 4 * pixels + 4096,
            .seconds = limits.image_seconds};
}

ImageResult decode(ImageFormat format, std::string_view bytes, const fs::path& file, const SourceLocation& where,
                   std::uint64_t most_pixels, const Limits& limits) {
    ImageResult result = decode_in_process(format, bytes, budget_for(most_pixels, bytes.size(), limits));
    if (!result.end.empty())
        throw refusal(file, where, "cannot be read: " + result.end,
                      result.end.starts_with("it takes too much time") ? how_to_raise(limits, &Limits::image_seconds)
                                                                       : other_image);
    return result;
}

// The picture of a reply that says it is done, if its size bears that out.
Image texels_of(const ImageResult& result, const fs::path& file, const SourceLocation& where) {
    const std::string_view body = result.body();
    const std::uint64_t pixels = std::uint64_t{result.reply.width} * result.reply.height;
    constexpr std::uint32_t largest_side = 1u << 30;
    if (pixels == 0 || std::max(result.reply.width, result.reply.height) > largest_side || body.size() != 4 * pixels)
        throw refusal(file, where, "cannot be read: its decoder broke", other_image);
    Image image{static_cast<int>(result.reply.width), static_cast<int>(result.reply.height), {}, result.reply.clipped};
    image.texels.resize(pixels);
    std::memcpy(image.texels.data(), body.data(), body.size());
    for (std::uint32_t& texel : image.texels) texel &= 0xFF'FFFF;
    return image;
}

}  // namespace

Image decode_image(std::string_view bytes, const fs::path& file, const Limits& limits, const SourceLocation& where) {
    const auto format = format_of(bytes);
    if (!format) throw refusal(file, where, "is not of a supported format", readable_formats);
    const std::uint64_t plausible = small_image + limits.image_pixels_per_byte * bytes.size();
    const ImageResult result = decode(*format, bytes, file, where, std::min(plausible, limits.image_pixels), limits);
    const ImageReply& reply = result.reply;
    if (reply.status == ImageReply::failed)
        throw refusal(file, where, "cannot be read: " + printable(result.body()), other_image);
    const std::uint64_t pixels = std::uint64_t{reply.width} * reply.height;
    if (reply.status == ImageReply::too_large) {
        const bool packed = pixels > plausible;
        throw refusal(
            file, where,
            "claims " + std::to_string(reply.width) + " x " + std::to_string(reply.height) + " pixels, " +
                (packed ? "more than so small a file can hold" : "which is too large"),
            packed ? "save it smaller, or with less compression" : how_to_raise(limits, &Limits::image_pixels));
    }
    return texels_of(result, file, where);
}

Image read_image(const fs::path& file, const Limits& limits, const SourceLocation& where, const FileOpener& open) {
    try {
        return decode_image(read_file_bytes(open(file), limits.image_bytes).text(), file, limits, where);
    } catch (const FileProblem& problem) {
        throw refusal(file, where, problem.what(),
                      problem.too_large ? how_to_raise(limits, &Limits::image_bytes) : readable_formats);
    }
}

}  // namespace raywalk
