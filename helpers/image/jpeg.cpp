#include "helpers/image/jpeg.h"

// clang-format off: jpeglib.h wants size_t and FILE to be known
#include <jerror.h>
#include <jpeglib.h>
#include <cstddef>
#include <cstdio>
// clang-format on

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "helpers/image/orientation.h"

namespace raywalk {

namespace {

// libjpeg leaves by longjmp, so the functions that call it own nothing themselves.
struct JpegErrors {
    jpeg_error_mgr manager;  // first: libjpeg's pointer to it is a pointer to this
    std::jmp_buf exit;
    std::array<char, JMSG_LENGTH_MAX> message;
    bool incomplete;  // data are missing or damaged, and grey was put in their place
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    jpeg->err->format_message(jpeg, errors->message.data());
    std::longjmp(errors->exit, 1);
}

void on_message(j_common_ptr jpeg, int level) {
    const int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER))
        reinterpret_cast<JpegErrors*>(jpeg->err)->incomplete = true;
}

// Each scan of a progressive JPEG goes over the whole picture, however few bytes it has: a small file of thousands
// would take minutes. Programs write 10 or 20, and 64 when they try hard.
constexpr int most_scans = 100;

constexpr int exif_marker = JPEG_APP0 + 1;  // where cameras say how they were held

void on_progress(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans) return;
    auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    std::snprintf(errors->message.data(), errors->message.size(), "it has more than %d scans", most_scans);
    std::longjmp(errors->exit, 1);
}

void prepare(JpegErrors& errors) {
    jpeg_std_error(&errors.manager);
    errors.manager.error_exit = on_error;
    errors.manager.emit_message = on_message;
    errors.manager.output_message = [](j_common_ptr) {};
    errors.incomplete = false;
}

bool read_header(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::span<const char> bytes) {
    if (setjmp(errors.exit)) return false;
    jpeg_create_decompress(&jpeg);
    jpeg.progress = static_cast<jpeg_progress_mgr*>(jpeg.client_data);  // kept where creation clears the rest
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_save_markers(&jpeg, exif_marker, 0xFFFF);
    jpeg_read_header(&jpeg, TRUE);
    const bool four_inks = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    jpeg.out_color_space = four_inks ? JCS_CMYK : JCS_EXT_RGBX;  // four bytes a pixel, as texels have them
    return true;
}

bool read_rows(jpeg_decompress_struct& jpeg, JpegErrors& errors, Image& image) {
    if (setjmp(errors.exit)) return false;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        auto* row =
            reinterpret_cast<JSAMPROW>(image.texels.data() + std::size_t{jpeg.output_scanline} * jpeg.output_width);
        jpeg_read_scanlines(&jpeg, &row, 1);
    }
    return true;
}

int orientation_of(const jpeg_decompress_struct& jpeg) {
    constexpr std::string_view beginning("Exif\0\0", 6);
    for (const auto* marker = jpeg.marker_list; marker != nullptr; marker = marker->next) {
        const std::span<const unsigned char> data(marker->data, marker->data_length);
        if (marker->marker == exif_marker && data.size() > beginning.size() &&
            std::equal(beginning.begin(), beginning.end(), data.begin()))
            return exif_orientation(data.subspan(beginning.size()));
    }
    return 1;
}

// CMYK as Adobe writes it: 255 is no ink.
std::uint32_t from_inks(std::uint32_t inks) {
    const std::uint32_t black = inks >> 24;
    const auto channel = [&](int shift) { return ((inks >> shift & 255) * black + 127) / 255 << shift; };
    return channel(0) | channel(8) | channel(16);
}

std::string decode(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::span<const char> bytes,
                   const ImageRefusal& refusal, Image& image) {
    if (!read_header(jpeg, errors, bytes)) return errors.message.data();
    if (std::string reason = refusal(jpeg.image_width, jpeg.image_height); !reason.empty()) return reason;
    image.width = static_cast<int>(jpeg.image_width);
    image.height = static_cast<int>(jpeg.image_height);
    image.texels.resize(std::size_t{jpeg.image_width} * jpeg.image_height);
    if (!read_rows(jpeg, errors, image)) return errors.message.data();
    if (errors.incomplete) return "it is damaged or ends too early";
    const bool inks = jpeg.out_color_space == JCS_CMYK;
    for (std::uint32_t& texel : image.texels) texel = inks ? from_inks(texel) : texel & 0xFF'FFFF;
    turn_upright(image, orientation_of(jpeg));
    return {};
}

// What libjpeg writes, piece by piece.
struct JpegOutput {
    jpeg_destination_mgr manager;  // first: libjpeg's pointer to it is a pointer to this
    EncodedFile* file;
    std::array<JOCTET, 1 << 16> piece;
};

void begin_piece(j_compress_ptr jpeg) {
    auto* output = reinterpret_cast<JpegOutput*>(jpeg->dest);
    output->manager.next_output_byte = output->piece.data();
    output->manager.free_in_buffer = output->piece.size();
}

void write_piece(j_compress_ptr jpeg, std::size_t size) {
    const auto* output = reinterpret_cast<JpegOutput*>(jpeg->dest);
    if (!output->file->append({reinterpret_cast<const char*>(output->piece.data()), size}))
        ERREXIT(jpeg, JERR_FILE_WRITE);
}

boolean end_piece(j_compress_ptr jpeg) {
    write_piece(jpeg, reinterpret_cast<JpegOutput*>(jpeg->dest)->piece.size());
    begin_piece(jpeg);
    return TRUE;
}

void end_output(j_compress_ptr jpeg) {
    const auto* output = reinterpret_cast<JpegOutput*>(jpeg->dest);
    write_piece(jpeg, output->piece.size() - output->manager.free_in_buffer);
}

bool write_all(jpeg_compress_struct& jpeg, JpegErrors& errors, std::span<std::uint8_t> row, const NextRows& next) {
    if (setjmp(errors.exit)) return false;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    for (int i = 0; i < jpeg.num_components; ++i) jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        if (!next(std::as_writable_bytes(row))) ERREXIT(&jpeg, JERR_INPUT_EOF);
        JSAMPROW start = row.data();
        jpeg_write_scanlines(&jpeg, &start, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

}  // namespace

std::string decode_jpeg(std::span<const char> bytes, const ImageRefusal& refusal, Image& image) {
    jpeg_decompress_struct jpeg{};
    JpegErrors errors{};
    jpeg_progress_mgr progress{};
    prepare(errors);
    progress.progress_monitor = on_progress;
    jpeg.err = &errors.manager;
    jpeg.client_data = &progress;
    std::string problem = decode(jpeg, errors, bytes, refusal, image);
    jpeg_destroy_decompress(&jpeg);
    return problem;
}

std::string encode_jpeg(const ImageEncoding& picture, const NextRows& next, EncodedFile& file) {
    if (picture.width > JPEG_MAX_DIMENSION || picture.height > JPEG_MAX_DIMENSION)
        return "a JPEG has at most 65500 pixels on a side";
    jpeg_compress_struct jpeg{};
    JpegErrors errors{};
    const auto output = std::make_unique<JpegOutput>();
    output->manager.init_destination = begin_piece;
    output->manager.empty_output_buffer = end_piece;
    output->manager.term_destination = end_output;
    output->file = &file;
    prepare(errors);
    jpeg.err = &errors.manager;
    jpeg_create_compress(&jpeg);
    jpeg.dest = &output->manager;
    jpeg.image_width = static_cast<JDIMENSION>(picture.width);
    jpeg.image_height = static_cast<JDIMENSION>(picture.height);
    std::vector<std::uint8_t> row(static_cast<std::size_t>(picture.width) * 3);
    const bool written = write_all(jpeg, errors, row, next);
    jpeg_destroy_compress(&jpeg);
    return written ? std::string() : errors.message.data();
}

}  // namespace raywalk
