// The codecs of the program raywalk_openimageio: TIFF, EXR and HDR.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "helpers/image/codecs.h"
#include "helpers/image/orientation.h"

namespace raywalk {

namespace {

constexpr int most_channels = 64;  // more is no picture; the first three are read

// The name of a format's plugin; nullptr for formats that the other helper has.
const char* plugin_name(ImageFormat format) {
    switch (format) {
        case ImageFormat::tiff:
            return "tiff";
        case ImageFormat::exr:
            return "openexr";
        case ImageFormat::hdr:
            return "hdr";
        case ImageFormat::png:
        case ImageFormat::jpeg:
            break;
    }
    return nullptr;
}

// The first line of what OpenImageIO says went wrong.
std::string first_line(const std::string& message) {
    if (message.empty()) return "it is damaged";
    if (message.find("bad_alloc") != std::string::npos) return "it needs too much memory";
    return message.substr(0, message.find('\n'));
}

bool is_above_one(float value) { return value > 1.0f + 0.5f / 255; }
bool is_above_one(std::uint8_t) { return false; }

std::uint32_t to_byte(float value) {
    if (!(value > 0)) return 0;  // NaN too
    return static_cast<std::uint32_t>(std::lround(std::min(value, 1.0f) * 255.0f));
}
std::uint32_t to_byte(std::uint8_t value) { return value; }

template <class Value>
std::uint32_t texel(const Value* channels, int count) {
    const std::uint32_t red = to_byte(channels[0]);
    if (count < 3) return red | red << 8 | red << 16;
    return red | to_byte(channels[1]) << 8 | to_byte(channels[2]) << 16;
}

// Rows [begin, end) of the image, converted to texels.
template <class Value>
bool read_rows(OIIO::ImageInput& input, OIIO::TypeDesc type, int begin, int end, int channels, Image& image) {
    const OIIO::ImageSpec& spec = input.spec();
    const std::size_t width = static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(end - begin);
    std::vector<Value> values(width * rows * static_cast<std::size_t>(channels));
    const bool tiled = spec.tile_width > 0;  // then begin..end is the whole image
    const bool read =
        tiled ? input.read_image(0, 0, 0, channels, type, values.data())
              : input.read_scanlines(0, 0, spec.y + begin, spec.y + end, spec.z, 0, channels, type, values.data());
    if (!read) return false;
    std::uint32_t* texels = image.texels.data() + width * static_cast<std::size_t>(begin);
    for (std::size_t i = 0; i < width * rows; ++i) {
        const Value* value = &values[i * static_cast<std::size_t>(channels)];
        texels[i] = texel(value, channels);
        image.clipped += std::any_of(value, value + channels, [](Value v) { return is_above_one(v); });
    }
    return true;
}

std::string read_pixels(OIIO::ImageInput& input, Image& image) {
    constexpr int band = 64;  // rows at a time: a picture is never held twice
    const OIIO::ImageSpec spec = input.spec();
    const int channels = spec.nchannels >= 3 ? 3 : 1;
    const bool bytes = spec.format == OIIO::TypeDesc::UINT8;
    const int step = spec.tile_width > 0 ? spec.height : band;
    image.width = spec.width;
    image.height = spec.height;
    image.texels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    for (int y = 0; y < spec.height; y += step) {
        const int end = std::min(y + step, spec.height);
        if (!(bytes ? read_rows<std::uint8_t>(input, OIIO::TypeDesc::UINT8, y, end, channels, image)
                    : read_rows<float>(input, OIIO::TypeDesc::FLOAT, y, end, channels, image)))
            return first_line(input.geterror());
    }
    return {};
}

// --- writing ---

// The file that OpenImageIO writes to. It closes and opens nothing.
class EncodedProxy : public OIIO::Filesystem::IOProxy {
  public:
    explicit EncodedProxy(EncodedFile& file) : IOProxy("image", Write), file_(&file) {}
    [[nodiscard]] const char* proxytype() const override { return "raywalk"; }
    size_t write(const void* data, size_t size) override {
        const size_t written = pwrite(data, size, m_pos);
        m_pos += static_cast<std::int64_t>(written);
        return written;
    }
    size_t pwrite(const void* data, size_t size, std::int64_t offset) override {
        return file_->write_at(static_cast<std::uint64_t>(offset), {static_cast<const char*>(data), size}) ? size : 0;
    }
    [[nodiscard]] size_t size() const override { return file_->size(); }

  private:
    EncodedFile* file_;
};

constexpr int block_rows = 16;  // compressed together, as EXR's ZIP does

// 32-bit floats, lossless: ZIP (EXR), deflate with the predictor for floats (TIFF), or uncompressed where it is urgent.
// HDR has three bytes below a common exponent (Ward, Real Pixels, Graphics Gems II, 1991), run-length coded.
OIIO::ImageSpec spec_of(const ImageEncoding& picture, OIIO::Filesystem::IOProxy& proxy) {
    OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::FLOAT);
    OIIO::Filesystem::IOProxy* pointer = &proxy;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &pointer);
    spec.attribute("DateTime", "");  // else it is now
    // Level 3 takes a third less time than the usual one; the file is larger by a twentieth.
    spec.attribute("compression", picture.urgent ? "none" : "zip:3");
    if (picture.format == ImageFormat::tiff) {
        if (!picture.urgent) spec.attribute("tiff:predictor", 3);
        spec.attribute("tiff:RowsPerStrip", block_rows);
    }
    return spec;
}

// HDR has no exponent for more, and no negative values; NaN becomes 0.
void clamp_for_hdr(std::span<float> values) {
    constexpr float largest = 0x1.FFFFFEp126f;
    for (float& value : values) value = value > 0 ? std::min(value, largest) : 0.0f;
}

std::string write_pixels(OIIO::ImageOutput& output, const OIIO::ImageSpec& spec, const ImageEncoding& picture,
                         const NextRows& next, int processors) {
    if (!output.open("image", spec)) return first_line(output.geterror());
    const int band = block_rows * std::max(processors, 4);  // OpenEXR compresses the blocks of one call side by side
    const std::size_t row_values = static_cast<std::size_t>(picture.width) * 3;
    std::vector<float> values;
    for (int y = 0; y < picture.height; y += band) {
        const int end = std::min(y + band, picture.height);
        values.resize(static_cast<std::size_t>(end - y) * row_values);
        if (!next(std::as_writable_bytes(std::span(values)))) return "its rows end too early";
        if (picture.format == ImageFormat::hdr) clamp_for_hdr(values);
        if (!output.write_scanlines(y, end, 0, OIIO::TypeDesc::FLOAT, values.data()))
            return first_line(output.geterror());
    }
    return output.close() ? "" : first_line(output.geterror());
}

}  // namespace

void use_one_thread() {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);
}

std::string decode_pixels(ImageFormat format, std::span<const char> bytes, const ImageRefusal& refusal, Image& image) {
    try {
        const char* plugin = plugin_name(format);
        // Before the input, which still asks it while it ends.
        OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());  // it only reads
        const auto input = plugin ? OIIO::ImageInput::create(plugin) : nullptr;
        if (!input) return "OpenImageIO cannot read its format";
        OIIO::ImageSpec wishes, spec;
        OIIO::Filesystem::IOProxy* proxy = &memory;
        wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as the file has them, not dimmed by alpha
        if (!input->open("image", spec, wishes)) return first_line(input->geterror());
        if (spec.deep || spec.depth > 1) return "it is no flat picture";
        if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) return "it is empty";
        if (spec.nchannels > most_channels) return "it has " + std::to_string(spec.nchannels) + " channels";
        const auto width = static_cast<std::uint64_t>(spec.width), height = static_cast<std::uint64_t>(spec.height);
        if (std::string reason = refusal(width, height); !reason.empty()) return reason;
        // A tile may be larger than its picture.
        if (spec.tile_width > 0) {
            const std::uint64_t tile =
                static_cast<std::uint64_t>(spec.tile_width) * static_cast<std::uint64_t>(spec.tile_height);
            if (tile > width * height + 65'536)
                if (std::string reason = refusal(static_cast<std::uint64_t>(spec.tile_width),
                                                 static_cast<std::uint64_t>(spec.tile_height));
                    !reason.empty())
                    return reason;
        }
        std::string problem = read_pixels(*input, image);
        if (problem.empty()) turn_upright(image, spec.get_int_attribute("Orientation", 1));
        input->close();
        return problem;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return error.what();
    }
}

std::string encode_picture(const ImageEncoding& picture, const NextRows& next, EncodedFile& file) {
    try {
        const char* plugin = plugin_name(picture.format);
        EncodedProxy proxy(file);  // before the output, which still writes to it while it ends after a failure
        const auto output = plugin ? OIIO::ImageOutput::create(plugin) : nullptr;
        if (!output || !output->supports("ioproxy")) return "OpenImageIO cannot write its format";
        const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        OIIO::attribute("threads", processors);
        OIIO::attribute("exr_threads", processors);
        return write_pixels(*output, spec_of(picture, proxy), picture, next, processors);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace raywalk
