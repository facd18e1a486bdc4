// Running programs in tests: what they print, and how they end.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace raywalk::test {

struct Process {
    std::vector<std::string> words;             // the program and its arguments
    std::vector<std::string> environment = {};  // "NAME=value" to set; "NAME" to unset
    std::filesystem::path folder = ".";         // to run in
    // What stdout and stderr go to: by default pipes whose text is kept.
    std::filesystem::path output_file = {};  // stdout to this file (/dev/full)
    bool closed_output = false;
    int terminal_columns = 0;               // above 0: stderr is a terminal of this width
    std::size_t memory_limit = 0;           // bytes of address space; 0: none
    std::size_t file_size_limit = 0;        // bytes of a file written; 0: none
    std::size_t stack_limit = 0;            // bytes; 0: none
    std::function<void(int)> started = {};  // called with the process id
};

struct Outcome {
    int exit_code = -1;  // -1 where a signal ended it
    int signal = 0;
    std::string output, errors;
};

// Waits for the end, at most two minutes.
Outcome run(const Process& process);

// An empty folder of its own that goes away with it.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& text);

// The files .NAME-PID-N.part of a folder: where a program was killed between naming and renaming a new file.
std::vector<std::filesystem::path> parts_in(const std::filesystem::path& folder);

}  // namespace raywalk::test
