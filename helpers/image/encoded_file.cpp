#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "helpers/image/codecs.h"

namespace raywalk {

bool EncodedFile::write_at(std::uint64_t offset, std::string_view bytes) {
    constexpr std::size_t most_kept = 1 << 18;
    if (offset != kept_at_ + kept_.size() || kept_.size() + bytes.size() > most_kept) flush();
    if (kept_.empty()) kept_at_ = offset;
    if (bytes.size() < most_kept)
        kept_ += bytes;
    else
        write_through(offset, bytes);
    size_ = std::max(size_, offset + bytes.size());
    return error_ == 0;
}

bool EncodedFile::flush() {
    write_through(kept_at_, kept_);
    kept_.clear();
    return error_ == 0;
}

void EncodedFile::write_through(std::uint64_t offset, std::string_view bytes) {
    while (!bytes.empty() && error_ == 0) {
        const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            error_ = errno;
            return;
        }
        offset += static_cast<std::uint64_t>(count);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

}  // namespace raywalk
