#include "tracer/ground/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, int error) {
    throw WorkError("cannot write '" + file.string() + "': " + std::generic_category().message(error));
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

// Where the name leads: renaming over a link would replace the link, not what it points to.
fs::path followed(const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_symlink(file, ignored)) return file;
    const fs::path target = fs::weakly_canonical(file, ignored);
    return ignored ? file : target;
}

bool is_special(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored) && !fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored);
}

// A new, empty file beside `file`: ".name-XXXXXX.ext".
fs::path new_file_beside(const fs::path& file) {
    const std::string extension = file.extension().string();
    std::string name = (folder_of(file) / ("." + file.stem().string() + "-XXXXXX" + extension)).string();
    const int descriptor = mkstemps(name.data(), static_cast<int>(extension.size()));
    if (descriptor < 0) fail(file, errno);
    // mkstemps makes files that only their owner may read; a picture gets the usual rights.
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(descriptor, 0666 & ~mask);
    close(descriptor);
    return name;
}

// Data first, then the name: after a power failure the name stands for the old file or the whole new one.
void flush_to_disk(const fs::path& file, const fs::path& written) {
    const int descriptor = open(written.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail(file, errno);
    const int error = fsync(descriptor) == 0 ? 0 : errno;
    close(descriptor);
    if (error != 0 && error != EINVAL && error != ENOTSUP) fail(file, error);
}

}  // namespace

void write_whole(const fs::path& file, const std::function<void(const fs::path&)>& write) {
    const fs::path target = followed(file);
    if (is_special(target)) return write(target);
    const fs::path temporary = new_file_beside(target);
    try {
        write(temporary);
        flush_to_disk(file, temporary);
        if (rename(temporary.c_str(), target.c_str()) != 0) fail(file, errno);
    } catch (...) {
        unlink(temporary.c_str());
        throw;
    }
}

void write_whole(const fs::path& file, std::string_view text) {
    write_whole(file, [&](const fs::path& path) {
        const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (descriptor < 0) fail(file, errno);
        std::string_view rest = text;
        while (!rest.empty()) {
            const ssize_t count = ::write(descriptor, rest.data(), rest.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) {
                const int error = errno;
                close(descriptor);
                fail(file, error);
            }
            rest.remove_prefix(static_cast<std::size_t>(count));
        }
        if (close(descriptor) != 0) fail(file, errno);
    });
}

std::string obstacle_to_writing(const fs::path& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) return "it is a folder";
    const fs::path target = followed(file);
    if (is_special(target)) return access(target.c_str(), W_OK) == 0 ? "" : std::generic_category().message(errno);
    const fs::path folder = folder_of(target);
    if (!fs::exists(folder, error)) return "its folder '" + folder.string() + "' does not exist";
    if (!fs::is_directory(folder, error)) return "'" + folder.string() + "' is not a folder";
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return "its folder '" + folder.string() + "': " + std::generic_category().message(errno);
    return {};
}

}  // namespace raywalk
