// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace raywalk {

// Calls write(path) with a new name in the folder of `file` that keeps its extension, then renames what was written to
// `file`. When `write` throws, or anything else fails, the new file is removed and `file` stays as it was. A `file`
// that is a device or pipe (/dev/null) is written to directly. Throws WorkError naming the file and the reason.
void write_whole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write);
void write_whole(const std::filesystem::path& file, std::string_view text);

// Why a file of this name could not be made ("its folder 'x' does not exist"); empty when it seems that it could.
std::string obstacle_to_writing(const std::filesystem::path& file);

}  // namespace raywalk
