#include "tracer/files/image/helper_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "tracer/files/helper_program.h"
#include "tracer/files/image/encode.h"
#include "tracer/ground/error.h"

namespace raywalk {

namespace {

// A file in memory, for what goes to the helper and comes back.
class MemoryFile {
  public:
    explicit MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
        if (fd_ < 0) fail_with("no memory for an image", errno);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(fd_); }

    [[nodiscard]] int descriptor() const { return fd_; }
    void fill(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t count = write(fd_, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail_with("no memory for an image", errno);
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
        lseek(fd_, 0, SEEK_SET);
    }
    // From now on nobody changes it.
    void seal() const { fcntl(fd_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL); }
    [[nodiscard]] FileBytes content() const {
        struct stat status {};
        if (fstat(fd_, &status) != 0) fail_with("an image's decoder left nothing", errno);
        FileBytes bytes(static_cast<std::size_t>(status.st_size));
        std::size_t done = 0;
        while (done < bytes.text().size()) {
            const ssize_t count = pread(fd_, bytes.data() + done, bytes.text().size() - done, static_cast<off_t>(done));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail_with("an image cannot be taken from its decoder", count < 0 ? errno : EIO);
            done += static_cast<std::size_t>(count);
        }
        return bytes;
    }

  private:
    int fd_;
};

// The way of samples to the helper: a socket rather than a pipe, as writing to a helper that has ended must fail, and
// not end this program (SIGPIPE).
class Channel {
  public:
    Channel() {
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()) != 0)
            fail_with("no way to an image's encoder", errno);
    }
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;
    ~Channel() {
        close_near_end();
        close_far_end();
    }

    [[nodiscard]] int far_end() const { return ends_[1]; }
    void close_near_end() { close_end(0); }
    void close_far_end() { close_end(1); }
    // False when the helper reads no more.
    [[nodiscard]] bool send(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t count = ::send(ends_[0], bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) return false;
            bytes = bytes.subspan(static_cast<std::size_t>(count));
        }
        return true;
    }

  private:
    void close_end(std::size_t end) {
        if (ends_[end] >= 0) close(std::exchange(ends_[end], -1));
    }
    std::array<int, 2> ends_{};
};

const char* helper_of(ImageFormat format) {
    const bool light = format == ImageFormat::png || format == ImageFormat::jpeg;
    return light ? "raywalk_png_jpeg" : "raywalk_openimageio";
}

// By the clock: generous, as many decoders may share a core.
double wall_seconds(const ImageBudget& budget) {
    return budget.seconds == 0 ? 0 : 10 + 5 * static_cast<double>(budget.seconds);
}

// What there is of the helper's reply, and how it ended.
ImageResult result_of(const MemoryFile& got, std::string end) {
    got.seal();
    ImageResult result{{}, got.content(), std::move(end)};
    if (result.output.text().size() >= sizeof(ImageReply))
        std::memcpy(&result.reply, result.output.text().data(), sizeof(ImageReply));
    if (result.end.empty() && result.reply.magic != ImageReply::magic_number) result.end = "its codec said nothing";
    return result;
}

}  // namespace

ImageResult decode_in_process(ImageFormat format, std::string_view input, const ImageBudget& budget) {
    const MemoryFile given("raywalk-image-in"), got("raywalk-image-out");
    given.fill(input);
    given.seal();
    RunningHelper helper(
        helper_of(format),
        {"decode", std::to_string(static_cast<int>(format)), std::to_string(budget.pixels),
         std::to_string(budget.memory_bytes), std::to_string(budget.output_bytes), std::to_string(budget.seconds)},
        std::array{given.descriptor(), got.descriptor()});
    std::string end = helper.end(wall_seconds(budget));
    return result_of(got, std::move(end));
}

std::string encode_in_process(const ImageEncoding& picture, const RowsOfSamples& rows, int file) {
    const MemoryFile got("raywalk-image-reply");
    Channel channel;
    RunningHelper helper(helper_of(picture.format),
                         {"encode", std::to_string(static_cast<int>(picture.format)), std::to_string(picture.width),
                          std::to_string(picture.height), picture.urgent ? "urgent" : "unhurried"},
                         std::array{channel.far_end(), got.descriptor(), file});
    channel.close_far_end();
    // Until it reads no more: it has ended then, and says why.
    for (int y = 0; y < picture.height; y += rows_at_a_time)
        if (!channel.send(rows(y, std::min(y + rows_at_a_time, picture.height)))) break;
    channel.close_near_end();
    const ImageResult result = result_of(got, helper.end(0));
    if (!result.end.empty()) return result.end;
    return result.reply.status == ImageReply::done ? "" : std::string(result.body());
}

std::string obstacle_to_encoding(ImageFormat format) {
    try {
        close(open_helper(helper_of(format)));
        return {};
    } catch (const WorkError& error) {
        return error.what();
    }
}

}  // namespace raywalk
