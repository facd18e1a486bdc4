#include "tracer/description/image_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "tracer/description/image_encode.h"
#include "tracer/ground/error.h"

extern char** environ;

namespace raywalk {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& step, int error) {
    throw WorkError(step + ": " + std::generic_category().message(error));
}

// A file in memory, for what goes to the helper and comes back.
class MemoryFile {
  public:
    explicit MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC)) {
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
    [[nodiscard]] FileBytes content() const {
        return read_file_bytes("/proc/self/fd/" + std::to_string(fd_), ~std::uint64_t{0});
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
            fail("no way to an image's encoder", errno);
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

// The helper beside the program (as built), or in ../lib/raywalk from there (as installed).
fs::path helper_program(ImageFormat format) {
    const bool light = format == ImageFormat::png || format == ImageFormat::jpeg;
    const std::string name = light ? "raywalk_png_jpeg" : "raywalk_openimageio";
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& folder : {here, here / "../lib/raywalk"})
        if (access((folder / name).c_str(), X_OK) == 0) return folder / name;
    throw WorkError("the program " + name + " is neither in " + here.string() + " nor in ../lib/raywalk from there");
}

// What somebody's other programs want of OpenImageIO (a thousand threads, say) would break the helper's budget.
std::vector<char*> without_settings_of_codecs(char** variables) {
    std::vector<char*> kept;
    for (; *variables != nullptr; ++variables) {
        const std::string_view variable = *variables;
        if (!variable.starts_with("OPENIMAGEIO") && !variable.starts_with("OIIO")) kept.push_back(*variables);
    }
    kept.push_back(nullptr);
    return kept;
}

// Starts the helper with `input` and `output` as its first two files and silence as its third: what libraries print is
// no message of ours; `picture`, if any, is its fourth. In a process group of its own, so that Ctrl-C does not reach it
// while a picture is saved.
pid_t start(const fs::path& program, std::vector<std::string> arguments, int input, int output, int picture = -1) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, 0);
    posix_spawn_file_actions_adddup2(&files, output, 1);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
    if (picture >= 0) posix_spawn_file_actions_adddup2(&files, picture, encoded_file);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    std::vector<char*> variables = without_settings_of_codecs(environ);
    pid_t pid = 0;
    const int error = posix_spawn(&pid, program.c_str(), &files, &attributes, words.data(), variables.data());
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) fail("'" + program.string() + "' cannot be run", error);
    return pid;
}

// Waits for the helper; how it ended, in words, empty when normally.
std::string end_of(pid_t pid) {
    int status = 0;
    while (waitpid(pid, &status, 0) < 0) {
        if (errno == EINTR) continue;
        return {};  // nobody keeps its status for us; its reply says enough
    }
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        return "it takes too much time or memory";
    if (WIFSIGNALED(status)) return std::string("its codec broke (") + strsignal(WTERMSIG(status)) + ")";
    if (WEXITSTATUS(status) == 127) throw WorkError("a codec of images cannot start; are its libraries installed?");
    return WEXITSTATUS(status) == 0 ? "" : "its codec gave up";
}

// A helper that takes what it is sent; ended with this, should that come first.
class RunningHelper {
  public:
    explicit RunningHelper(pid_t pid) : pid_(pid) {}
    RunningHelper(const RunningHelper&) = delete;
    RunningHelper& operator=(const RunningHelper&) = delete;
    ~RunningHelper() {
        if (pid_ == 0) return;
        kill(pid_, SIGKILL);
        while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
    }
    std::string end() { return end_of(std::exchange(pid_, 0)); }

  private:
    pid_t pid_;
};

// What there is of the helper's reply, and how it ended.
ImageResult result_of(const MemoryFile& got, std::string end) {
    ImageResult result{{}, got.content(), std::move(end)};
    if (result.output.text().size() >= sizeof(ImageReply))
        std::memcpy(&result.reply, result.output.text().data(), sizeof(ImageReply));
    if (result.end.empty() && result.reply.magic != ImageReply::magic_number) result.end = "its codec said nothing";
    return result;
}

}  // namespace

ImageResult decode_in_process(ImageFormat format, std::string_view input, const ImageBudget& budget) {
    const fs::path program = helper_program(format);
    const MemoryFile given("raywalk-image-in"), got("raywalk-image-out");
    given.fill(input);
    const pid_t pid = start(
        program,
        {program.string(), "decode", std::to_string(static_cast<int>(format)), std::to_string(budget.pixels),
         std::to_string(budget.memory_bytes), std::to_string(budget.output_bytes), std::to_string(budget.seconds)},
        given.descriptor(), got.descriptor());
    return result_of(got, end_of(pid));
}

std::string encode_in_process(const ImageEncoding& picture, const RowsOfSamples& rows, int file) {
    const fs::path program = helper_program(picture.format);
    const MemoryFile got("raywalk-image-reply");
    Channel channel;
    RunningHelper helper(
        start(program,
              {program.string(), "encode", std::to_string(static_cast<int>(picture.format)),
               std::to_string(picture.width), std::to_string(picture.height), picture.urgent ? "urgent" : "unhurried"},
              channel.far_end(), got.descriptor(), file));
    channel.close_far_end();
    // Until it reads no more: it has ended then, and says why.
    for (int y = 0; y < picture.height; y += rows_at_a_time)
        if (!channel.send(rows(y, std::min(y + rows_at_a_time, picture.height)))) break;
    channel.close_near_end();
    const ImageResult result = result_of(got, helper.end());
    if (!result.end.empty()) return result.end;
    return result.reply.status == ImageReply::done ? "" : std::string(result.body());
}

std::string obstacle_to_encoding(ImageFormat format) {
    try {
        helper_program(format);
        return {};
    } catch (const WorkError& error) {
        return error.what();
    }
}

}  // namespace raywalk
