// The words of OBJ files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tracer/files/blank.h"

namespace raywalk {

// Statements that say nothing about triangles: of numbers, whose lines may be continued, and of names. A backslash at
// the end of a name (of a folder, say) is part of it.
bool is_number_statement(std::string_view word);
bool is_name_statement(std::string_view word);

constexpr bool ends_word(char c) { return static_cast<unsigned char>(c) <= ' ' && (is_blank(c) || c == '\n'); }

// A word as far as it may be a number or a corner: a comment may follow it without a blank (but "1.#INF" is a number of
// sorts), and so may a continued line end. A newline has to follow it somewhere.
std::string_view value_at(const char* at);

// A whole number at the start of a text: [+-]digits.
struct WrittenIndex {
    std::uint64_t value = 0;  // without its sign; as large as can be where the digits say more
    bool negative = false;
    std::size_t length = 0;  // 0 if there is none
};

WrittenIndex read_index(std::string_view text);

// Makes each carriage return that ends a line (none of "\r\n" does) a newline. What follows `text` is looked at.
void unify_line_ends(char* text, std::size_t size);

}  // namespace raywalk
