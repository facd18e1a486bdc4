#include "tracer/files/image/helper_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "tracer/files/helper_program.h"
#include "tracer/ground/error.h"

namespace raywalk {

namespace {

[[noreturn]] void fail(const std::string& step, int error) {
    throw WorkError(step + ": " + std::generic_category().message(error));
}

// A file in memory, for what goes to the helper and comes back.
class MemoryFile {
  public:
    explicit MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
        if (fd_ < 0) fail("no memory for an image", errno);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(fd_); }

    [[nodiscard]] int descriptor() const { return fd_; }
    void fill(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t count = write(fd_, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail("no memory for an image", errno);
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
        lseek(fd_, 0, SEEK_SET);
    }
    // From now on nobody changes it.
    void seal() const { fcntl(fd_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL); }
    [[nodiscard]] FileBytes content() const {
        struct stat status {};
        if (fstat(fd_, &status) != 0) fail("an image's decoder left nothing", errno);
        FileBytes bytes(static_cast<std::size_t>(status.st_size));
        std::size_t done = 0;
        while (done < bytes.text().size()) {
            const ssize_t count = pread(fd_, bytes.data() + done, bytes.text().size() - done, static_cast<off_t>(done));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail("an image cannot be taken from its decoder", count < 0 ? errno : EIO);
            done += static_cast<std::size_t>(count);
        }
        return bytes;
    }

  private:
    int fd_;
};

const char* helper_of(ImageFormat format) {
    const bool light = format == ImageFormat::png || format == ImageFormat::jpeg;
    return light ? "raywalk_png_jpeg" : "raywalk_openimageio";
}

// By the clock: generous, as many decoders may share a core.
double wall_seconds(const ImageBudget& budget) {
    return budget.seconds == 0 ? 0 : 10 + 5 * static_cast<double>(budget.seconds);
}

ImageResult run(ImageFormat format, std::vector<std::string> arguments, std::string_view input, double seconds) {
    arguments.insert(arguments.begin() + 1, std::to_string(static_cast<int>(format)));
    const MemoryFile given("raywalk-image-in"), got("raywalk-image-out");
    given.fill(input);
    given.seal();
    RunningHelper helper(helper_of(format), std::move(arguments), std::array{given.descriptor(), got.descriptor()});
    std::string end = helper.end(seconds);
    got.seal();
    ImageResult result{{}, got.content(), std::move(end)};
    if (result.output.text().size() >= sizeof(ImageReply))
        std::memcpy(&result.reply, result.output.text().data(), sizeof(ImageReply));
    if (result.end.empty() && result.reply.magic != ImageReply::magic_number) result.end = "its decoder said nothing";
    return result;
}

}  // namespace

ImageResult decode_in_process(ImageFormat format, std::string_view input, const ImageBudget& budget) {
    return run(format,
               {"decode", std::to_string(budget.pixels), std::to_string(budget.memory_bytes),
                std::to_string(budget.output_bytes), std::to_string(budget.seconds)},
               input, wall_seconds(budget));
}

ImageResult encode_in_process(int width, int height, std::string_view input) {
    return run(ImageFormat::jpeg, {"encode", std::to_string(width), std::to_string(height)}, input, 0);
}

}  // namespace raywalk
