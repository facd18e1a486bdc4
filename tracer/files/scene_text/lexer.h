// Scene text -> lines of words. Blank lines and comments are gone; every word knows its column.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace raywalk {

// A word of a line. A word in double quotes may hold blanks; `text` is without the quotes.
struct Word {
    std::string_view text;
    std::size_t column = 1;  // in bytes, from 1, of the first byte (the quote, if quoted)
    std::size_t length = 1;  // bytes in the file, quotes included
    bool quoted = false;
};

// More than any property has, and a bound on what a line without an end can cost.
inline constexpr std::size_t most_words = 16;

struct SceneLine {
    std::string_view text;    // the whole line, without its end
    std::size_t number = 0;   // from 1
    std::vector<Word> words;  // never empty; no more than most_words, the rest of a longer line is left out
    bool open_quote = false;  // the last word's closing quote is missing
};

// Walks over the lines of a text that say something. A byte order mark, CRLF and a missing last newline are fine.
class SceneLexer {
  public:
    explicit SceneLexer(std::string_view text);

    // The next line with words into `line` (whose memory is reused); false at the end.
    bool next(SceneLine& line);

  private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

// The first byte that has no place in a scene (NUL, other control characters, what is not UTF-8), or npos.
std::size_t first_foreign_byte(std::string_view text);

}  // namespace raywalk
