// What the program says on stderr, and writes on stdout.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/ground/error.h"

namespace raywalk {

// How stderr may be written to: `rewritable` lines (a terminal that is not dumb) and colours (NO_COLOR unset).
struct Console {
    bool rewritable = false, colours = false;
};
Console standard_error();

// "raywalk: error: what", to stderr, whole lines only. A stderr that nobody reads keeps no message waiting for long.
void print_error(std::string_view what);
void print_warning(std::string_view what);
// "raywalk: what"
void print_note(std::string_view what);

// `text` as it is, to stderr; what does not fit there at once is dropped.
void show_if_ready(std::string_view text);

// Each with its line and caret. A diagnostic without its line gets it from the file, if it can be read.
void print_diagnostics(std::span<const Diagnostic> diagnostics);

// To stdout; throws WorkError when it is closed or full.
void print_result(std::string_view text);

// "8.1 ms", "0.26 s", "12.3 s", "3 min 5 s", "1 h 2 min".
std::string duration_text(double seconds);
// "1 sample", "2 samples", "10,000 samples".
std::string count_text(std::uint64_t count, std::string_view singular, std::string_view plural = {});

}  // namespace raywalk
