// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace raywalk {

// Writes a new file beside `file` and renames it to `file` when all of it is on the disk: whatever happens on the way,
// `file` is the old one or the whole new one. The new file has no name until it is whole (where the file system can),
// so that a killed program leaves nothing behind; only between the last two steps, naming and renaming, it leaves the
// whole new file as .NAME-PID-0.part. A `file` that is a device or pipe (/dev/null) is written to directly.
// Throws WorkError naming the file and the reason.
void write_whole(const std::filesystem::path& file, std::string_view bytes);

// Why a file of this name could not be made ("its folder 'x' does not exist"); empty when it seems that it could.
std::string obstacle_to_writing(const std::filesystem::path& file);

}  // namespace raywalk
