// Whole files in memory, read with care: only regular files, only within a budget, never blocking.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tracer/ground/descriptor.h"

namespace raywalk {

// Bytes of a file. A copy rather than a mapping: a file that shrinks while it is mapped kills the reader (SIGBUS), and
// the copy costs little beside parsing. `padding` newlines follow the text, so that scanners need no end test.
class FileBytes {
  public:
    static constexpr std::size_t padding = 64;

    explicit FileBytes(std::size_t size);

    [[nodiscard]] std::string_view text() const { return {data_.get(), size_}; }
    [[nodiscard]] char* data() { return data_.get(); }

  private:
    std::unique_ptr<char[]> data_;
    std::size_t size_;
};

// Why a file could not be read, as the end of a sentence: "is a folder", "cannot be opened: Permission denied". The
// input's fault: callers place it and throw InputError.
class FileProblem : public std::runtime_error {
  public:
    explicit FileProblem(const std::string& what, bool over_budget = false)
        : std::runtime_error(what), too_large(over_budget) {}
    bool too_large;  // the budget was the reason
};

// The problem of a file that could not be opened, by its errno. Throws WorkError where it is none of the file's.
FileProblem unopened(const std::filesystem::path& file, int error);

// Opens a file for reading: whatever can be opened, without waiting. Throws FileProblem.
Descriptor open_file(const std::filesystem::path& file);
// The same where rights are to be checked.
using FileOpener = std::function<Descriptor(const std::filesystem::path&)>;

// Reads a regular file of at most `most_bytes`. Throws FileProblem, also for a large one that is mostly holes. Large
// files are read by several threads.
FileBytes read_file_bytes(const Descriptor& file, std::uint64_t most_bytes);

// As above, a file of text: a large one with any hole is refused unread.
FileBytes read_text_bytes(const Descriptor& file, std::uint64_t most_bytes);

// What would keep `file` from being read (it is missing, a folder, a device, not readable); empty when nothing would.
std::string file_problem(const std::filesystem::path& file);

}  // namespace raywalk
