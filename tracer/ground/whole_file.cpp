#include "tracer/ground/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, int error) {
    throw WorkError("cannot write " + quoted_name(file.string()) + ": " + std::generic_category().message(error));
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

// Where the name leads: renaming over a link would replace the link, not what it points to.
fs::path followed(const fs::path& file) {
    std::error_code error;
    if (!fs::is_symlink(file, error)) return file;
    const fs::path target = fs::weakly_canonical(file, error);
    return error ? file : target;
}

bool is_special(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored) && !fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored);
}

// An open file that is closed in the end.
class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int number() const { return number_; }

    // 0, or the error.
    [[nodiscard]] int write(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t count = ::write(number_, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) return errno;
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
        return 0;
    }
    [[nodiscard]] int flush_to_disk() const {
        if (fsync(number_) == 0 || errno == EINVAL || errno == ENOTSUP) return 0;
        return errno;
    }
    [[nodiscard]] int close() {
        const int error = ::close(number_) == 0 ? 0 : errno;
        number_ = -1;
        return error;
    }

  private:
    int number_;
};

// Tries names ".NAME-0.part", ... beside `file` until one is free; `make` returns 0 or -1 and errno.
template <class Make>
fs::path free_name_beside(const fs::path& file, const Make& make) {
    constexpr std::size_t kept = 200;  // of a long name: with what is added here it stays below the usual 255 bytes
    const std::string start = "." + file.filename().string().substr(0, kept) + "-" + std::to_string(getpid()) + "-";
    for (int i = 0;; ++i) {
        fs::path name = folder_of(file) / (start + std::to_string(i) + ".part");
        if (make(name) >= 0) return name;
        if (errno != EEXIST) return {};
    }
}

// Gives the written file the name of `target`. Returns 0, or the error, and then there is no new name.
int rename_to(const fs::path& name, const fs::path& target) {
    if (rename(name.c_str(), target.c_str()) == 0) return 0;
    const int error = errno;
    unlink(name.c_str());
    return error;
}

// Into a device or a pipe.
void write_directly(const fs::path& file, const fs::path& target, std::string_view bytes) {
    // Opening a pipe that nobody reads would wait for ever.
    Descriptor descriptor(open(target.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (descriptor.number() < 0 && errno == ENXIO)
        throw WorkError("cannot write " + quoted_name(file.string()) + ": nothing reads from it");
    if (descriptor.number() < 0) fail(file, errno);
    fcntl(descriptor.number(), F_SETFL, O_WRONLY);  // from here on a full pipe is waited for
    if (const int error = descriptor.write(bytes)) fail(file, error);
    if (const int error = descriptor.close()) fail(file, error);
}

// True when done, false where the file system has no files without a name.
bool write_without_name(const fs::path& file, const fs::path& target, std::string_view bytes) {
    const Descriptor descriptor(open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    if (descriptor.number() < 0) return false;
    if (const int error = descriptor.write(bytes)) fail(file, error);
    if (const int error = descriptor.flush_to_disk()) fail(file, error);
    const std::string itself = "/proc/self/fd/" + std::to_string(descriptor.number());
    // A file without a name can be given a free one only, hence the second step.
    const fs::path name = free_name_beside(target, [&](const fs::path& free) {
        return linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, free.c_str(), AT_SYMLINK_FOLLOW);
    });
    if (name.empty()) return false;  // no /proc here
    if (const int error = rename_to(name, target)) fail(file, error);
    return true;
}

void write_with_name(const fs::path& file, const fs::path& target, std::string_view bytes) {
    int number = -1;
    const fs::path name = free_name_beside(target, [&](const fs::path& free) {
        return number = open(free.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    });
    if (name.empty()) fail(file, errno);
    Descriptor descriptor(number);
    int error = descriptor.write(bytes);
    if (error == 0) error = descriptor.flush_to_disk();
    if (const int close_error = descriptor.close(); error == 0) error = close_error;
    if (error == 0)
        error = rename_to(name, target);
    else
        unlink(name.c_str());
    if (error != 0) fail(file, error);
}

}  // namespace

void write_whole(const fs::path& file, std::string_view bytes) {
    const fs::path target = followed(file);
    if (is_special(target)) return write_directly(file, target, bytes);
    if (!write_without_name(file, target, bytes)) write_with_name(file, target, bytes);
}

std::string obstacle_to_writing(const fs::path& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) return "it is a folder";
    // A name that is too long, a link that leads to itself; only that nothing is there yet is no obstacle.
    struct stat status {};
    if (stat(file.c_str(), &status) != 0 && errno != ENOENT && errno != ENOTDIR)
        return std::generic_category().message(errno);
    const fs::path target = followed(file);
    if (is_special(target)) return access(target.c_str(), W_OK) == 0 ? "" : std::generic_category().message(errno);
    const fs::path folder = folder_of(target);
    if (!fs::exists(folder, error)) return "its folder " + quoted_name(folder.string()) + " does not exist";
    if (!fs::is_directory(folder, error)) return quoted_name(folder.string()) + " is not a folder";
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return "its folder " + quoted_name(folder.string()) + ": " + std::generic_category().message(errno);
    return {};
}

}  // namespace raywalk
