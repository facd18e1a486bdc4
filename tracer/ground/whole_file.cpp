#include "tracer/ground/whole_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

// The rights that the new file of `target` starts with; `old` is what it replaces, if there is any.
mode_t rights_beside(const std::optional<struct stat>& old) { return old ? old->st_mode & 0600 : 0666; }

std::optional<struct stat> status_of(const fs::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return std::nullopt;
    return status;
}

// The new file gets owner, group and rights of the old one; what is not allowed stays as it is, but never opens the
// file to anyone who could not read the old one.
void copy_rights(int descriptor, const struct stat& old) {
    const bool same_group = fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) == 0;
    [[maybe_unused]] const int owner = fchown(descriptor, old.st_uid, static_cast<gid_t>(-1));
    const mode_t of_others = (old.st_mode & 07) << 3;
    const mode_t mode = same_group ? old.st_mode & 0777 : old.st_mode & (0707 | of_others);
    [[maybe_unused]] const int rights = fchmod(descriptor, mode);
}

bool is_special(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored) && !fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored);
}

// Writes all of `bytes`; `write_some(bytes)` returns how many it wrote, or -1 and errno. Returns 0, or the error.
template <class Write>
int write_all(std::string_view bytes, const Write& write_some) {
    while (!bytes.empty()) {
        const ssize_t count = write_some(bytes);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
}

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

// A new file in the folder of `target`, without a name; -1 where there is no such thing.
int open_without_name(const fs::path& target, mode_t rights) {
    // It gets its name by way of /proc.
    if (access("/proc/self/fd", X_OK) != 0) return -1;
    return open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, rights);
}

// Why a rename to `target` would fail although its folder can be written to.
std::string obstacle_to_replacing(const fs::path& target, const fs::path& folder) {
    const std::optional<struct stat> old = status_of(target), around = status_of(folder);
    if (!old || !around) return {};
    const uid_t self = geteuid();
    if ((around->st_mode & S_ISVTX) != 0 && self != 0 && old->st_uid != self && around->st_uid != self)
        return "it is another user's, and in " + quoted_name(folder.string()) + " only its owner may replace it";
#ifdef STATX_MNT_ID
    struct statx file {
    }, place{};
    if (statx(AT_FDCWD, target.c_str(), 0, STATX_MNT_ID, &file) != 0 ||
        statx(AT_FDCWD, folder.c_str(), 0, STATX_MNT_ID, &place) != 0)
        return {};
    if ((file.stx_attributes & (STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND)) != 0) return "it is marked unchangeable";
    if ((place.stx_attributes & (STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND)) != 0)
        return "its folder " + quoted_name(folder.string()) + " is marked unchangeable";
    if ((file.stx_mask & place.stx_mask & STATX_MNT_ID) != 0 && file.stx_mnt_id != place.stx_mnt_id)
        return "it is mounted by itself, and cannot be replaced";
#endif
    return {};
}

}  // namespace

WholeFile::WholeFile(fs::path file)
    : file_(std::move(file)), target_(written_file(file_)), is_direct_(is_special(target_)) {
    if (is_direct_) {
        descriptor_ = memfd_create("raywalk-file", MFD_CLOEXEC);
        if (descriptor_ < 0) fail(errno);
        return;
    }
    const std::optional<struct stat> old = status_of(target_);
    descriptor_ = open_without_name(target_, rights_beside(old));
    if (descriptor_ < 0) {
        part_ = free_name_beside(target_, [&](const fs::path& free) {
            return descriptor_ = open(free.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, rights_beside(old));
        });
        if (part_.empty()) fail(errno);
    }
    if (old) copy_rights(descriptor_, *old);
}

WholeFile::~WholeFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!part_.empty()) unlink(part_.c_str());
}

void WholeFile::fail(int error) const { fail_with("cannot write " + quoted_name(file_.string()), error); }

void WholeFile::append(std::string_view bytes) {
    const int error =
        write_all(bytes, [&](std::string_view rest) { return ::write(descriptor_, rest.data(), rest.size()); });
    if (error != 0) fail(error);
}

void WholeFile::write_directly() {
    // Opening a pipe that nobody reads would wait for ever.
    const int target = open(target_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (target < 0 && errno == ENXIO)
        throw WorkError("cannot write " + quoted_name(file_.string()) + ": nothing reads from it");
    if (target < 0) fail(errno);
    fcntl(target, F_SETFL, O_WRONLY);                        // from here on a full pipe is waited for
    const int content = std::exchange(descriptor_, target);  // closed whatever happens, as the new file is
    std::array<char, 1 << 16> piece;
    ssize_t count = 0;
    off_t at = 0;
    int error = 0;
    while (error == 0 && (count = pread(content, piece.data(), piece.size(), at)) > 0) {
        error = write_all({piece.data(), static_cast<std::size_t>(count)},
                          [&](std::string_view rest) { return ::write(target, rest.data(), rest.size()); });
        at += count;
    }
    if (count < 0) error = errno;
    close(content);
    if (error != 0) fail(error);
    close_file();
}

void WholeFile::close_file() {
    if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);
}

void WholeFile::finish(Durability durability) {
    if (is_direct_) return write_directly();
    if (durability == Durability::on_disk && fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP)
        fail(errno);
    if (part_.empty()) {
        // A file without a name can be given a free one only, hence the second step.
        const std::string itself = "/proc/self/fd/" + std::to_string(descriptor_);
        part_ = free_name_beside(target_, [&](const fs::path& free) {
            return linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, free.c_str(), AT_SYMLINK_FOLLOW);
        });
        if (part_.empty()) fail(errno);
    }
    close_file();
    if (rename(part_.c_str(), target_.c_str()) != 0) fail(errno);
    part_.clear();
}

void write_whole(const fs::path& file, std::string_view bytes, Durability durability) {
    WholeFile whole(file);
    whole.append(bytes);
    whole.finish(durability);
}

fs::path written_file(const fs::path& file) {
    std::error_code error;
    if (!fs::is_symlink(file, error)) return file;
    // Link by link, since what the last one names need not be there yet; as many as the system follows.
    constexpr int most_links = 40;
    fs::path target = file;
    for (int i = 0; i < most_links && fs::is_symlink(target, error); ++i) {
        const fs::path next = fs::read_symlink(target, error);
        if (error) return file;
        target = folder_of(target) / next;  // as it is where `next` is absolute
    }
    return target;
}

bool appears_whole(const fs::path& file) { return !is_special(written_file(file)); }

std::string obstacle_to_writing(const fs::path& file) {
    std::error_code error;
    if (fs::is_directory(file, error)) return "it is a folder";
    // A name that is too long, a link that leads to itself; only that nothing is there yet is no obstacle.
    struct stat status {};
    if (stat(file.c_str(), &status) != 0 && errno != ENOENT && errno != ENOTDIR)
        return std::generic_category().message(errno);
    const fs::path target = written_file(file);
    if (is_special(target)) return access(target.c_str(), W_OK) == 0 ? "" : std::generic_category().message(errno);
    const fs::path folder = folder_of(target);
    if (!fs::exists(folder, error)) return "its folder " + quoted_name(folder.string()) + " does not exist";
    if (!fs::is_directory(folder, error)) return quoted_name(folder.string()) + " is not a folder";
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return "its folder " + quoted_name(folder.string()) + ": " + std::generic_category().message(errno);
    return obstacle_to_replacing(target, folder);
}

}  // namespace raywalk
