#include "helpers/image/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <new>

namespace raywalk {

namespace {

// What libpng's callbacks share. libpng leaves by longjmp, so the functions that call it own nothing themselves.
struct PngTask {
    const char* at = nullptr;  // input not yet read
    std::size_t left = 0;
    std::string problem = {};
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::vector<png_bytep> rows = {};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    static_cast<PngTask*>(png_get_error_ptr(png))->problem = message;
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

}  // namespace

std::string decode_png(std::span<const char> bytes, const ImageRefusal& refusal, Image& image) {
    PngTask task{.at = bytes.data(), .left = bytes.size()};
    task.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &task, on_error, on_warning);
    if (task.png) task.info = png_create_info_struct(task.png);
    if (!task.info) throw std::bad_alloc();
    std::string problem = decode(task, refusal, image);
    png_destroy_read_struct(&task.png, &task.info, nullptr);
    for (std::uint32_t& texel : image.texels) texel &= 0xFF'FFFF;  // without alpha
    return problem;
}

}  // namespace raywalk
