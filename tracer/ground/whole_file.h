// Files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace raywalk {

// When a file counts as written.
enum class Durability {
    on_disk,   // when its content is on the disk: not even a loss of power leaves less than the old file or the new one
    in_system  // when the system has its content: the same, whatever happens to this program alone
};

// A file that is written piece by piece, and appears when it is whole: a new file beside `file` is renamed to `file`,
// so that whatever happens on the way, `file` is the old one or the whole new one. The new file has no name until it
// is whole (where the file system can), so that a killed program leaves nothing behind; only between the last two
// steps, naming and renaming, it leaves the whole new file as .NAME-PID-0.part. A `file` that is a device or pipe
// (/dev/null) is written to directly, in the end. A file that is replaced keeps its rights, and its owner and group
// where that is allowed; where it is a link, what it leads to is replaced or made. Every function throws WorkError
// naming the file and the reason.
class WholeFile {
  public:
    explicit WholeFile(std::filesystem::path file);
    ~WholeFile();  // a file that was not finished leaves nothing
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void append(std::string_view bytes);
    // The new file itself, open for writing: another process may write it instead.
    [[nodiscard]] int descriptor() const { return descriptor_; }
    void finish(Durability durability = Durability::on_disk);

  private:
    [[noreturn]] void fail(int error) const;
    void close_file();
    void write_directly();

    std::filesystem::path file_, target_;  // the name given, and where links lead from there
    std::filesystem::path part_;           // name of the new file; empty: none yet
    bool is_direct_;                       // a device or pipe: the new file is in memory, and copied in the end
    int descriptor_ = -1;                  // of the new file
};

// The same in one step.
void write_whole(const std::filesystem::path& file, std::string_view bytes,
                 Durability durability = Durability::on_disk);

// The file that a WholeFile of this name writes: where links lead from there, as renaming over a link would replace the
// link. What the last one names need not be there yet.
std::filesystem::path written_file(const std::filesystem::path& file);

// Whether a WholeFile of this name appears whole: it is no device and no pipe.
bool appears_whole(const std::filesystem::path& file);

// Why a file of this name could not be made ("its folder 'x' does not exist"); empty when it seems that it could.
std::string obstacle_to_writing(const std::filesystem::path& file);

}  // namespace raywalk
