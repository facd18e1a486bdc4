#include "helpers/image/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string_view>

#include "helpers/image/orientation.h"

namespace raywalk {

namespace {

// Strategies of zlib for png_set_compression_strategy: Z_DEFAULT_STRATEGY and Z_RLE, whose header is not needed else.
constexpr int any = 0, rle = 3;

// What libpng's callbacks share when they read. libpng leaves by longjmp, so the functions that call it own nothing
// themselves.
struct PngTask {
    const char* at = nullptr;  // input not yet read
    std::size_t left = 0;
    std::string problem = {};
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::vector<png_bytep> rows = {};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, png_size_t size) {
    auto& task = *static_cast<PngTask*>(png_get_io_ptr(png));
    if (size > task.left) png_error(png, "it ends too early");
    std::memcpy(to, task.at, size);
    task.at += size;
    task.left -= size;
}

// Up to the header: width, height, and rows that will come as red, green, blue and something, as texels have it.
bool read_header(PngTask& task) {
    if (setjmp(png_jmpbuf(task.png))) return false;
    png_set_user_limits(task.png, 0x7FFF'FFFF, 0x7FFF'FFFF);  // the budget is checked by the caller
    // Only what makes the pixels is looked at: a text or a profile of a small file may claim gigabytes.
    png_set_keep_unknown_chunks(task.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_read_fn(task.png, &task, on_read);
    png_read_info(task.png, task.info);
    png_set_expand(task.png);
    png_set_scale_16(task.png);
    png_set_gray_to_rgb(task.png);
    png_set_filler(task.png, 0, PNG_FILLER_AFTER);
    png_set_interlace_handling(task.png);
    png_read_update_info(task.png, task.info);
    return true;
}

bool read_rows(PngTask& task) {
    if (setjmp(png_jmpbuf(task.png))) return false;
    png_read_image(task.png, task.rows.data());
    return true;
}

std::string decode(PngTask& task, const ImageRefusal& refusal, Image& image) {
    if (!read_header(task)) return task.problem;
    const png_uint_32 width = png_get_image_width(task.png, task.info);
    const png_uint_32 height = png_get_image_height(task.png, task.info);
    if (std::string reason = refusal(width, height); !reason.empty()) return reason;
    if (png_get_rowbytes(task.png, task.info) != std::size_t{width} * 4) return "its rows are damaged";
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.texels.resize(std::size_t{width} * height);
    for (std::size_t y = 0; y < height; ++y)
        task.rows.push_back(reinterpret_cast<png_bytep>(image.texels.data() + y * width));
    return read_rows(task) ? std::string() : task.problem;
}

// What the eXIf chunk says (PNG 3rd edition, 11.3.4.5): libpng is told to skip all that makes no pixels.
int orientation_of(std::span<const char> file) {
    constexpr std::size_t signature = 8, before_data = 8, checksum = 4;
    for (std::size_t at = signature; at + before_data <= file.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(file[at + i]);
        const std::string_view type(&file[at + 4], 4);
        at += before_data;
        if (length > file.size() - at) break;
        if (type == "eXIf") return exif_orientation({reinterpret_cast<const unsigned char*>(file.data()) + at, length});
        at += std::min(length + checksum, file.size() - at);
    }
    return 1;
}

void on_write(png_structp png, png_bytep data, png_size_t size) {
    if (!static_cast<EncodedFile*>(png_get_io_ptr(png))->append({reinterpret_cast<const char*>(data), size}))
        png_error(png, "it cannot be written");
}

bool write_all(png_structp png, png_infop info, const ImageEncoding& picture, std::span<std::uint8_t> row,
               const NextRows& next) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_user_limits(png, 0x7FFF'FFFF, 0x7FFF'FFFF);
    png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
    png_set_compression_level(png, picture.urgent ? 1 : 3);
    png_set_compression_strategy(png, picture.urgent ? rle : any);
    png_set_compression_buffer_size(png, 1 << 16);  // an IDAT chunk
    png_write_info(png, info);
    for (int y = 0; y < picture.height; ++y) {
        if (!next(std::as_writable_bytes(row))) png_error(png, "its rows end too early");
        png_write_row(png, row.data());
    }
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::string decode_png(std::span<const char> bytes, const ImageRefusal& refusal, Image& image) {
    PngTask task{.at = bytes.data(), .left = bytes.size()};
    task.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &task.problem, on_error, on_warning);
    if (task.png) task.info = png_create_info_struct(task.png);
    if (!task.info) throw std::bad_alloc();
    std::string problem = decode(task, refusal, image);
    png_destroy_read_struct(&task.png, &task.info, nullptr);
    for (std::uint32_t& texel : image.texels) texel &= 0xFF'FFFF;  // without alpha
    if (problem.empty()) turn_upright(image, orientation_of(bytes));
    return problem;
}

std::string encode_png(const ImageEncoding& picture, const NextRows& next, EncodedFile& file) {
    std::string problem;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &problem, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw std::bad_alloc();
    png_set_write_fn(png, &file, on_write, [](png_structp) {});
    std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width) * 3);
    write_all(png, info, picture, row, next);
    png_destroy_write_struct(&png, &info);
    return problem;
}

}  // namespace raywalk
