// A place in the text of an OBJ file, what can be passed there, and what is said of it.
#pragma once

#include <cstddef>
#include <string_view>

#include "tracer/files/mesh/obj_flaws.h"
#include "tracer/files/mesh/obj_words.h"

namespace raywalk {

// For the parser of a chunk to begin with: no statement is known here. Newlines have to follow the text.
class ObjCursor {
  protected:
    ObjCursor(std::string_view text, ObjFlaws& flaws)
        : p_(text.data()), end_(text.data() + text.size()), line_start_(p_), flaws_(flaws) {}

    // Passes blanks and continued line ends.
    void skip_blanks() {
        while (is_blank(*p_) || (*p_ == '\\' && pass_continuation())) ++p_;
    }
    bool pass_continuation();
    void skip_line();
    void skip_to_line_end();
    void skip_texture_coordinates() {
        // In one look unless its line is continued, or ends oddly.
        const char* end = p_;
        while (*end != '\n' && *end != '\r' && *end != '\\') ++end;
        if (*end == '\r' && end[1] == '\n') ++end;
        if (*end == '\n')
            p_ = end;
        else
            skip_line();
    }
    // Behind the last value of a statement, or before the comment behind it.
    [[nodiscard]] bool at_end_of_values() const { return *p_ == '\n' || *p_ == '#'; }
    [[nodiscard]] std::string_view word_at(const char* at) const;

    // `length`: of what is wrong; 0 for the whole word.
    void flaw(ObjFlaw kind, const char* at, std::size_t length, std::string_view what, std::string_view expected) {
        flaws_.add(kind, [&] { return remark(at, length, what, expected); });
    }
    [[nodiscard]] ObjRemark remark(const char* at, std::size_t length, std::string_view what,
                                   std::string_view expected) const;
    void no_such(ObjFlaw kind, std::string_view index);

    const char* p_;
    const char* end_;            // a newline stands there
    const char* line_start_;     // of the line that p_ is in
    std::size_t lines_ = 0;      // before that one
    bool lone_returns_ = false;  // a carriage return that ends a line was seen: the lines are others

  private:
    ObjFlaws& flaws_;
};

}  // namespace raywalk
