#include "tracer/ground/error.h"

#include <algorithm>
#include <system_error>

#include "tracer/ground/character_width.h"
#include "tracer/ground/utf8.h"

namespace raywalk {

namespace {

constexpr std::size_t shown_bytes = 100;  // of a long line
constexpr std::size_t shown_word = 40;    // bytes of a long word

// True at the first byte of a UTF-8 character.
bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

// Calls visit(character) for each character of UTF-8.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        const std::size_t length = std::max<std::size_t>(utf8_length(text), 1);
        visit(text.substr(0, length));
        text.remove_prefix(length);
    }
}

std::size_t columns(std::string_view text) {
    std::size_t count = 0;
    for_each_character(text, [&](std::string_view c) { count += static_cast<std::size_t>(columns_of(c)); });
    return count;
}

// What stands under `text` up to the caret: tabs under tabs, under each other character as many blanks as it is wide.
std::string margin_under(std::string_view text) {
    std::string margin;
    for_each_character(text, [&](std::string_view c) {
        if (c == "\t")
            margin += '\t';
        else
            margin.append(static_cast<std::size_t>(columns_of(c)), ' ');
    });
    return margin;
}

// True for a character (whole, UTF-8) that would steer a terminal rather than be seen: the control characters but tab,
// and those of Unicode that end lines or turn the direction of text (Boucher and Anderson, Trojan Source, 2021).
bool steers_terminal(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    if (first < 0x20 || first == 0x7F) return first != '\t';
    if (character.size() == 2) return character <= "\xC2\x9F" || character == "\xD8\x9C";
    return (character >= "\xE2\x80\x8E" && character <= "\xE2\x80\x8F") ||
           (character >= "\xE2\x80\xA8" && character <= "\xE2\x80\xAE") ||
           (character >= "\xE2\x81\xA6" && character <= "\xE2\x81\xA9");
}

// `where` as the line below the message shows it: the line, and a caret with waves under the place.
std::string caret_lines(const Diagnostic& d) {
    const std::string_view line = d.source_line;
    const std::size_t column = std::max<std::size_t>(d.where.column, 1) - 1;
    const std::size_t start = std::min(column - std::min(d.skipped, column), line.size());
    const std::string under = printable(line.substr(start, d.where.length));
    const std::string before = d.skipped > 0 ? "..." : "";
    return "\n  " + before + printable(line) + "\n  " + std::string(before.size(), ' ') +
           margin_under(printable(line.substr(0, start))) + "^" +
           std::string(std::max<std::size_t>(columns(under), 1) - 1, '~');
}

std::string joined(const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + to_string(d);
    return text;
}

}  // namespace

Diagnostic error_at(SourceLocation where, std::string what, std::string expected) {
    return {Severity::error, std::move(where), std::move(what), std::move(expected)};
}

Diagnostic warning_at(SourceLocation where, std::string what, std::string expected) {
    return {Severity::warning, std::move(where), std::move(what), std::move(expected)};
}

Diagnostic error_of_file(std::string file, std::string what, std::string expected) {
    return error_at({std::move(file)}, std::move(what), std::move(expected));
}

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for_each_character(text, [&](std::string_view character) {
        if (utf8_length(character) == 0 || steers_terminal(character))
            result += '?';
        else
            result += character;
    });
    return result;
}

std::string quoted(std::string_view word) {
    if (word.size() <= shown_word) return "'" + printable(word) + "'";
    std::size_t end = shown_word - 3;
    while (end > 0 && !starts_character(word[end])) --end;
    return "'" + printable(word.substr(0, end)) + "...'";
}

std::string quoted_name(const std::string& file) { return "'" + printable(file) + "'"; }

void quote_line(Diagnostic& diagnostic, std::string_view line) {
    std::size_t begin = 0, end = line.size();
    if (line.size() > shown_bytes) {
        const std::size_t place = std::min(std::max<std::size_t>(diagnostic.where.column, 1) - 1, line.size());
        if (place > shown_bytes / 2) begin = place - shown_bytes / 2;
        end = std::min(line.size(), begin + shown_bytes);
        while (begin > 0 && begin < place && !starts_character(line[begin])) ++begin;
        while (end > place && end < line.size() && !starts_character(line[end])) --end;
    }
    diagnostic.skipped = begin;
    diagnostic.source_line = line.substr(begin, end - begin);
    if (end < line.size()) diagnostic.source_line += "...";
}

std::string to_string(const Diagnostic& diagnostic) {
    std::string text = printable(diagnostic.where.file);
    if (diagnostic.where.line > 0)
        text += ":" + std::to_string(diagnostic.where.line) + ":" + std::to_string(diagnostic.where.column);
    text += diagnostic.severity == Severity::error ? ": error: " : ": warning: ";
    text += printable(diagnostic.what);
    const std::string expected = printable(diagnostic.expected);
    if (!diagnostic.source_line.empty()) {
        text += caret_lines(diagnostic);
        if (!expected.empty()) text += " " + expected;
    } else if (!expected.empty()) {
        text += "\n  " + expected;
    }
    return text;
}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(Diagnostic diagnostic) : InputError(std::vector{std::move(diagnostic)}) {}

void fail_with(const std::string& step, int error) {
    throw WorkError(step + ": " + std::generic_category().message(error));
}

}  // namespace raywalk
