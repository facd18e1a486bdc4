#include "tracer/files/mesh/obj_cursor.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace raywalk {

std::string_view ObjCursor::word_at(const char* at) const {
    const char* stop = at;
    while (stop < end_ && !ends_word(*stop)) ++stop;
    return {at, static_cast<std::size_t>(stop - at)};
}

ObjRemark ObjCursor::remark(const char* at, std::size_t length, std::string_view what,
                            std::string_view expected) const {
    const char* text_end = std::find(line_start_, end_, '\n');
    while (text_end > line_start_ && is_blank(text_end[-1])) --text_end;
    return {.line = lines_,
            .column = static_cast<std::size_t>(at - line_start_) + 1,
            .length = std::max<std::size_t>(length > 0 ? length : word_at(at).size(), 1),
            .source_line = {line_start_, static_cast<std::size_t>(text_end - line_start_)},
            .what = std::string(what),
            .expected = std::string(expected)};
}

// At a backslash: if only blanks and the line end follow, goes to the character before what it continues with, the next
// line. The last line of a file is continued by nothing.
bool ObjCursor::pass_continuation() {
    const char* newline = p_ + 1;
    while (is_blank(*newline)) ++newline;
    if (*newline != '\n') return false;
    if (newline >= end_) {
        p_ = newline - 1;
        return true;
    }
    p_ = newline;
    ++lines_;
    line_start_ = newline + 1;
    return true;
}

// Lines that were read to their newline are not looked at: a carriage return among their values is a blank. Where
// carriage returns end lines, others come to this.
void ObjCursor::skip_to_line_end() {
    p_ = static_cast<const char*>(std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_) + 1));
    const char* last = p_;
    while (last > line_start_ && last[-1] == '\r') --last;
    if (std::memchr(line_start_, '\r', static_cast<std::size_t>(last - line_start_)) != nullptr) lone_returns_ = true;
}

// To the line end, that of the last line where the statement is continued.
void ObjCursor::skip_line() {
    for (;;) {
        const char* begin = p_;
        skip_to_line_end();
        const char* last = p_;
        while (last > begin && is_blank(last[-1])) --last;
        const bool continued = last > begin && last[-1] == '\\' && p_ < end_ && std::find(begin, last, '#') == last;
        if (!continued) return;
        ++p_;
        ++lines_;
        line_start_ = p_;
    }
}

// `index`: as it stands in the text.
void ObjCursor::no_such(ObjFlaw kind, std::string_view index) {
    constexpr std::size_t shown = 20;
    const bool of_normal = kind == ObjFlaw::no_normal;
    const std::string list = of_normal ? "normals" : "vertices";
    const bool zero = index.find_first_not_of("+-0") == std::string_view::npos;
    flaw(kind, index.data(), index.size(),
         std::string("there is no ") + (of_normal ? "normal " : "vertex ") +
             (index.size() > shown ? quoted(index) : std::string(index)),
         zero              ? list + " count from 1, or from -1 backwards"
         : index[0] == '-' ? "not so many " + list + " stand above this line"
                           : "");  // how many there are is known later
}

}  // namespace raywalk
