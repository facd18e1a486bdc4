#include "app/walk/walk_script.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "tracer/ground/error.h"

namespace raywalk {

namespace {

constexpr std::string_view letters = "wsadUDLRt[]q";
constexpr std::string_view expected_letters =
    "expected w s a d (move), U D L R (turn), t (projection), [ ] (darker, brighter) or q (quit), each with a count "
    "before it or without";

[[noreturn]] void fail(std::string_view text, std::string_view name, std::size_t at, std::size_t length,
                       std::string what, std::string expected) {
    Diagnostic diagnostic = error_at({.file = std::string(name), .line = 1, .column = at + 1, .length = length},
                                     std::move(what), std::move(expected));
    quote_line(diagnostic, text);
    throw InputError(std::move(diagnostic));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// "did you mean 'w'?" for the other case of a key, and for the arrows of a keypad drawn as text.
std::string letter_hint(char letter) {
    for (const char other : letters)
        if (std::tolower(static_cast<unsigned char>(other)) == std::tolower(static_cast<unsigned char>(letter)))
            return std::string("did you mean '") + other + "'?";
    return std::string(expected_letters);
}

}  // namespace

WalkScript parse_walk_script(std::string_view text, std::string_view name) {
    WalkScript script;
    for (std::size_t i = 0; i < text.size();) {
        if (is_blank(text[i])) {
            ++i;
            continue;
        }
        const std::size_t start = i;
        std::size_t count = 0;
        for (; i < text.size() && is_digit(text[i]); ++i)
            count = std::min(count * 10 + static_cast<std::size_t>(text[i] - '0'), walk_script_presses + 1);
        const bool counted = i > start;
        const std::size_t count_length = i - start;
        while (counted && i < text.size() && is_blank(text[i])) ++i;

        if (i == text.size())
            fail(text, name, start, count_length, "a count without a key after it", std::string(expected_letters));
        if (letters.find(text[i]) == std::string_view::npos) {
            std::size_t length = 1;  // a whole UTF-8 character
            while (i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xC0) == 0x80) ++length;
            fail(text, name, i, length, "unknown key " + quoted(text.substr(i, length)), letter_hint(text[i]));
        }
        if (counted && count == 0)
            fail(text, name, start, count_length, "a count of 0", "leave the key out, or count from 1");
        const std::size_t presses = counted ? count : 1;
        if (presses > walk_script_presses - script.size())
            fail(text, name, start, i + 1 - start, "more than " + std::to_string(walk_script_presses) + " presses",
                 "split the walk");
        script.insert(script.end(), presses, static_cast<WalkKey>(text[i]));
        ++i;
    }
    return script;
}

}  // namespace raywalk
