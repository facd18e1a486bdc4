#include "tracer/ground/open_beneath.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>

#include <cerrno>
#include <utility>

namespace raywalk {

namespace {

// Non-blocking: opening a pipe must not wait for a writer.
constexpr int file_flags = O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY;

}  // namespace

Descriptor open_by_components(const Descriptor& folder, const std::filesystem::path& file) {
    Descriptor at(fcntl(folder.get(), F_DUPFD_CLOEXEC, 0));
    for (const std::filesystem::path& part : file.parent_path()) {
        if (!at.valid()) return at;
        if (part.is_absolute() || part == "..") {
            errno = EXDEV;
            return {};
        }
        at = Descriptor(openat(at.get(), part.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    }
    if (!at.valid()) return at;
    return Descriptor(openat(at.get(), file.filename().c_str(), file_flags | O_NOFOLLOW));
}

Descriptor open_beneath(const Descriptor& folder, const std::filesystem::path& file) {
    open_how how{};
    how.flags = static_cast<std::uint64_t>(file_flags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
    Descriptor opened(static_cast<int>(syscall(SYS_openat2, folder.get(), file.c_str(), &how, sizeof how)));
    // A sandbox may forbid a call that it does not know.
    if (!opened.valid() && (errno == ENOSYS || errno == EPERM)) return open_by_components(folder, file);
    return opened;
}

}  // namespace raywalk
