// Pictures in and out: the work of processes of their own (helper_process.h, encode.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "tracer/ground/error.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/scene/image.h"
#include "tracer/scene/limits.h"

namespace raywalk {

// Reads PNG, JPEG, TIFF, EXR or HDR (told by content, nothing else is tried). Throws InputError placed at `where`, also
// when a picture breaks its decoder, or takes too much memory or time.
Image read_image(const std::filesystem::path& file, const Limits& limits, const SourceLocation& where,
                 const FileOpener& open = open_file);
// The same for a file already in memory; `file` names it in messages.
Image decode_image(std::string_view bytes, const std::filesystem::path& file, const Limits& limits,
                   const SourceLocation& where);

// True for .png .jpg .jpeg .exr .pfm .hdr .tif .tiff (any case).
bool is_image_extension(const std::filesystem::path& file);
// True where the format holds linear floats (.exr .pfm .hdr .tif .tiff), false where it holds 8-bit display values.
bool is_float_extension(const std::filesystem::path& file);

enum class Saving {
    unhurried,  // compressed, and on the disk in the end
    urgent      // somebody waits for the program's end: larger, and known to the system, which brings it to the disk
};

// Writes `file` whole or not at all (see whole_file.h); the extension chooses the format. Throws WorkError naming the
// file and the system's reason. The same picture gives the same bytes, whatever the number of threads and the date.
void write_image(const std::filesystem::path& file, const FloatRows& picture, Saving saving = Saving::unhurried);
void write_image(const std::filesystem::path& file, const FloatImage& image, Saving saving = Saving::unhurried);
// 8-bit RGB, 3 bytes a pixel; formats as above (a float format gets value / 255).
void write_image(const std::filesystem::path& file, int width, int height, std::span<const std::uint8_t> rgb,
                 Saving saving = Saving::unhurried);

// Why an image of this name could not be written: as obstacle_to_writing (whole_file.h), or the program that encodes
// its format is missing.
std::string obstacle_to_writing_image(const std::filesystem::path& file);

}  // namespace raywalk
