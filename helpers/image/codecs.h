// Image formats: bytes in, bytes out. Used by the helper programs only (image_helper.cpp), which have one of two
// implementations: image_png_jpeg.cpp or image_openimageio.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/files/image/encode.h"
#include "tracer/files/image/helper_process.h"
#include "tracer/scene/image.h"

namespace raywalk {

// Says why an image of this size (pixels) is not wanted, before its pixels are read; empty when it is.
using ImageRefusal = std::function<std::string(std::uint64_t width, std::uint64_t height)>;

// Decodes `bytes` as `format`, and as nothing else: grey becomes RGB, alpha is dropped, values outside 0..1 are
// clamped and NaN is 0. Returns the reason of a failure, empty on success. Throws nothing but std::bad_alloc.
std::string decode_pixels(ImageFormat format, std::span<const char> bytes, const ImageRefusal& refusal, Image& image);

// The next rows of the picture that is encoded, as many as fill `to`: 3 samples a pixel. False when they end too early.
using NextRows = std::function<bool(std::span<std::byte> to)>;

// The file that a picture is encoded into. Neighbouring pieces are written together: some codecs write a few bytes at a
// time. After an error nothing is written any more.
class EncodedFile {
  public:
    explicit EncodedFile(int descriptor) : descriptor_(descriptor) {}
    // False after an error.
    bool write_at(std::uint64_t offset, std::string_view bytes);
    bool append(std::string_view bytes) { return write_at(size_, bytes); }
    // Writes what is still kept.
    bool flush();
    [[nodiscard]] int error() const { return error_; }  // of the system; 0: none
    [[nodiscard]] std::uint64_t size() const { return size_; }

  private:
    void write_through(std::uint64_t offset, std::string_view bytes);

    int descriptor_, error_ = 0;
    std::uint64_t size_ = 0;
    std::uint64_t kept_at_ = 0;  // where the kept bytes belong
    std::string kept_;
};

// Encodes a picture, of bytes (PNG, JPEG) or linear floats (EXR, TIFF, HDR); the same bytes for the same picture.
// Returns as decode_pixels does.
std::string encode_picture(const ImageEncoding& picture, const NextRows& next, EncodedFile& file);

// Keeps the codecs to the calling thread.
void use_one_thread();

}  // namespace raywalk
