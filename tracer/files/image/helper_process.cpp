#include "tracer/files/image/helper_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

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

// The helper beside the program (as built), or in ../lib/raywalk from there (as installed).
fs::path helper_program(ImageFormat format) {
    const bool light = format == ImageFormat::png || format == ImageFormat::jpeg;
    const std::string name = light ? "raywalk_png_jpeg" : "raywalk_openimageio";
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& folder : {here, here / "../lib/raywalk"})
        if (fs::exists(folder / name, error)) return folder / name;
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
// no message of ours. In a process group of its own, so that Ctrl-C does not reach it while a picture is saved.
pid_t start(const fs::path& program, std::vector<std::string>& arguments, int input, int output) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, 0);
    posix_spawn_file_actions_adddup2(&files, output, 1);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
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
    if (WIFSIGNALED(status)) return std::string("its decoder broke (") + strsignal(WTERMSIG(status)) + ")";
    if (WEXITSTATUS(status) == 127) throw WorkError("a decoder of images cannot start; are its libraries installed?");
    return WEXITSTATUS(status) == 0 ? "" : "its decoder gave up";
}

ImageResult run(ImageFormat format, std::vector<std::string> arguments, std::string_view input) {
    const fs::path program = helper_program(format);
    arguments.insert(arguments.begin() + 1, std::to_string(static_cast<int>(format)));
    arguments.insert(arguments.begin(), program.string());
    const MemoryFile given("raywalk-image-in"), got("raywalk-image-out");
    given.fill(input);
    std::string end = end_of(start(program, arguments, given.descriptor(), got.descriptor()));
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
               input);
}

ImageResult encode_in_process(int width, int height, std::string_view input) {
    return run(ImageFormat::jpeg, {"encode", std::to_string(width), std::to_string(height)}, input);
}

}  // namespace raywalk
