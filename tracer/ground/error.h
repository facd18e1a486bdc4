// What a wrong input is told: where, what, what was expected, what to do.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raywalk {

// A place in a text file. Lines and columns count from 1 (columns in bytes); 0 means "the file as a whole".
struct SourceLocation {
    std::string file = {};
    std::size_t line = 0;
    std::size_t column = 0;
    std::size_t length = 1;  // bytes under the caret
    friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

enum class Severity { warning, error };

// One message about one place. `source_line` is the offending line as written, or the part of a long line around the
// place (empty when there is none): set it with quote_line.
struct Diagnostic {
    Severity severity = Severity::error;
    SourceLocation where = {};
    std::string what = {};      // "unknown property 'cente'"
    std::string expected = {};  // "did you mean 'center'?" or what would be right; may be empty
    std::string source_line = {};
    std::size_t skipped = 0;  // bytes of the line left out before source_line, when the line is long
    bool quotable = true;     // false: the line is not to be shown, nor looked up
    friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

Diagnostic error_at(SourceLocation where, std::string what, std::string expected = {});
Diagnostic warning_at(SourceLocation where, std::string what, std::string expected = {});
// About a file as a whole.
Diagnostic error_of_file(std::string file, std::string what, std::string expected = {});

// Keeps of `line`, which diagnostic.where points into, what a message shows: at most about 100 bytes around the place.
void quote_line(Diagnostic& diagnostic, std::string_view line);

// 'word' for a message: cut when long, and safe to print on a terminal (see printable).
std::string quoted(std::string_view word);

// The whole name of a file, as quoted.
std::string quoted_name(const std::string& file);

// `text` with each character that would steer a terminal, and each byte that is not UTF-8, replaced by '?'.
std::string printable(std::string_view text);

// file:line:column: error: what
//   the line
//   ^~~~ expected
std::string to_string(const Diagnostic& diagnostic);

// Wrong input: one or several diagnostics (exit code 3).
class InputError : public std::runtime_error {
  public:
    explicit InputError(std::vector<Diagnostic> diagnostics);
    explicit InputError(Diagnostic diagnostic);
    [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

  private:
    std::vector<Diagnostic> diagnostics_;
};

// The work failed through no fault of the input: disk full, device lost (exit code 1).
class WorkError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// A step that the system refused, by its errno: "STEP: No such file or directory".
[[noreturn]] void fail_with(const std::string& step, int error);

}  // namespace raywalk
