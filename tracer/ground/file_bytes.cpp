#include "tracer/ground/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "tracer/ground/error.h"

namespace raywalk {

namespace {

constexpr std::size_t piece_bytes = std::size_t{4} << 20;  // bytes that one thread reads at a time

std::string reason(int error) { return std::generic_category().message(error); }

// What kind of thing `mode` says it is, when it is no regular file.
std::string kind_problem(mode_t mode) {
    if (S_ISREG(mode)) return {};
    if (S_ISDIR(mode)) return "is a folder";
    if (S_ISFIFO(mode)) return "is a pipe, not a regular file";
    if (S_ISSOCK(mode)) return "is a socket, not a regular file";
    return "is a device, not a regular file";
}

// Reads [begin, end) of the file; fewer bytes when it ends early. Returns the count, or -errno.
long read_piece(int fd, char* into, std::size_t begin, std::size_t end) {
    std::size_t done = begin;
    while (done < end) {
        const ssize_t n = pread(fd, into + done, end - done, static_cast<off_t>(done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return -errno;
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return static_cast<long>(done - begin);
}

// Bytes of the file that were ever written. The others are holes: they take no space on the disk, but memory and time
// when they are read, as bytes of zero.
std::uint64_t written_bytes(int fd, std::uint64_t size) {
    std::uint64_t count = 0;
    for (std::uint64_t at = 0; at < size;) {
        const off_t data = lseek(fd, static_cast<off_t>(at), SEEK_DATA);
        if (data < 0 && errno == ENXIO) break;  // a hole up to the end
        const off_t hole = data < 0 ? -1 : lseek(fd, data, SEEK_HOLE);
        if (hole < 0) return size;  // nobody knows here
        count += static_cast<std::uint64_t>(hole - data);
        at = static_cast<std::uint64_t>(hole);
    }
    return count;
}

// Throws for a file that would take much more memory than it takes space. No text has bytes of zero; other files have
// long stretches of them now and then, which some copying programs turn into holes.
void refuse_holes(int fd, std::uint64_t size, bool text) {
    constexpr std::uint64_t worth_a_look = 1 << 20, tolerable = 16 << 20;
    if (size < worth_a_look) return;
    const std::uint64_t written = written_bytes(fd, size);
    if (text && written < size) throw FileProblem("has holes, so it is no text");
    if (written < size / 2 && size - written > tolerable)
        throw FileProblem("has " + std::to_string(size) + " bytes, but only " + std::to_string(written) +
                          " were ever written; if it is right, copy it with cp --sparse=never");
}

}  // namespace

FileBytes::FileBytes(std::size_t size) : data_(new char[size + padding]), size_(size) {
    std::memset(data_.get() + size, '\n', padding);
}

namespace {

FileBytes read_bytes(const Descriptor& fd, std::uint64_t most_bytes, bool text) {
    struct stat before {};
    if (fstat(fd.get(), &before) != 0) throw FileProblem("cannot be examined: " + reason(errno));
    if (std::string kind = kind_problem(before.st_mode); !kind.empty()) throw FileProblem(kind);
    const auto size = static_cast<std::uint64_t>(before.st_size);
    if (size > most_bytes) throw FileProblem("has " + std::to_string(size) + " bytes", true);
    refuse_holes(fd.get(), size, text);

    FileBytes bytes(size);
    std::atomic<long> error{0};
    std::atomic<bool> changed{false};
    const auto pieces = static_cast<long>((size + piece_bytes - 1) / piece_bytes);
#pragma omp parallel for schedule(dynamic) if (pieces > 1)
    for (long i = 0; i < pieces; ++i) {
        const std::size_t begin = static_cast<std::size_t>(i) * piece_bytes;
        const std::size_t end = std::min<std::size_t>(begin + piece_bytes, size);
        const long n = read_piece(fd.get(), bytes.data(), begin, end);
        if (n < 0)
            error = -n;
        else if (static_cast<std::size_t>(n) < end - begin)
            changed = true;
    }
    if (error != 0) throw FileProblem("cannot be read: " + reason(static_cast<int>(error)));
    struct stat after {};
    if (fstat(fd.get(), &after) != 0) throw FileProblem("cannot be examined: " + reason(errno));
    const auto same_time = [](const timespec& a, const timespec& b) {
        return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
    };
    char more = 0;
    const bool longer = pread(fd.get(), &more, 1, static_cast<off_t>(size)) > 0;
    if (size == 0 && after.st_size == 0 && longer) throw FileProblem("is made up by the system, not a regular file");
    if (changed || longer || after.st_size != before.st_size || !same_time(after.st_mtim, before.st_mtim))
        throw FileProblem("changed while it was read; try again");
    return bytes;
}

}  // namespace

FileProblem unopened(const std::filesystem::path& file, int error) {
    if (error == EMFILE || error == ENFILE || error == ENOMEM)  // not the file's fault
        fail_with("cannot open " + quoted_name(file.string()), error);
    return FileProblem("cannot be opened: " + reason(error));
}

Descriptor open_file(const std::filesystem::path& file) {
    // Non-blocking: opening a pipe must not wait for a writer.
    Descriptor opened(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (!opened.valid()) throw unopened(file, errno);
    return opened;
}

FileBytes read_file_bytes(const Descriptor& file, std::uint64_t most_bytes) {
    return read_bytes(file, most_bytes, false);
}

FileBytes read_text_bytes(const Descriptor& file, std::uint64_t most_bytes) {
    return read_bytes(file, most_bytes, true);
}

std::string file_problem(const std::filesystem::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return "cannot be opened: " + reason(errno);
    if (std::string kind = kind_problem(status.st_mode); !kind.empty()) return kind;
    if (access(file.c_str(), R_OK) != 0) return "cannot be opened: " + reason(errno);
    return {};
}

}  // namespace raywalk
