#include "tracer/description/obj_chunk.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "tracer/ground/error.h"

namespace raywalk {

namespace {

// Statements of the OBJ format that say nothing about triangles.
constexpr std::string_view ignored_words[] = {
    "g",     "o",        "s",          "usemtl", "mtllib", "l",    "p",    "vp",   "mg",     "bevel",  "lod",
    "fo",    "c_interp", "d_interp",   "cstype", "deg",    "bmat", "step", "curv", "curv2",  "surf",   "parm",
    "trim",  "hole",     "scrv",       "sp",     "end",    "con",  "call", "csh",  "usemap", "maplib", "trace_obj",
    "ctech", "stech",    "shadow_obj", "cdp",    "cdc",    "res",  "bsp",  "bzp",
};

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool ends_word(char c) { return is_blank(c) || c == '\n'; }

// Powers of ten that single precision holds exactly.
constexpr float powers_of_ten[] = {1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f, 1e10f};

class ChunkParser {
  public:
    ChunkParser(std::string_view text, std::uint64_t most_faces, std::uint64_t most_errors)
        : p_(text.data()),
          end_(text.data() + text.size()),
          line_start_(p_),
          most_faces_(most_faces),
          most_errors_(most_errors) {}

    void parse() {
        while (p_ < end_ && out_.faces.size() <= most_faces_ && out_.errors.size() < most_errors_) parse_line();
    }
    ObjRemark locate(std::size_t face, int corner, bool normal);

    ObjChunk out_;

  private:
    struct Corner {
        std::uint32_t position, normal;
    };

    void parse_line();
    void parse_vertex();
    void parse_normal();
    void parse_face();
    void parse_other();
    bool parse_number(float& value, const char* name, const char* form);
    bool parse_number_slowly(float& value, const char* name, const char* form);
    bool parse_corner(Corner& corner);
    bool parse_index(std::uint32_t& index, std::size_t count, const char* list);
    void add_faces();

    // Passes blanks and continued line ends.
    void skip_blanks() {
        while (is_blank(*p_) || (*p_ == '\\' && pass_continuation())) ++p_;
    }
    bool pass_continuation();
    void skip_line() {
        // A line end after a backslash ends nothing.
        for (;;) {
            p_ = static_cast<const char*>(std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_) + 1));
            const char* last = p_;
            while (last > line_start_ && last[-1] == '\r') --last;
            if (last == line_start_ || last[-1] != '\\' || p_ >= end_) return;
            ++p_;
            ++out_.lines;
            line_start_ = p_;
        }
    }
    void fail(const char* at, std::string what, std::string expected) {
        out_.errors.push_back(remark(at, std::move(what), std::move(expected)));
    }
    ObjRemark remark(const char* at, std::string what, std::string expected) const;

    const char* p_;
    const char* end_;         // a newline stands there
    const char* line_start_;  // of the line that p_ is in
    std::uint64_t most_faces_, most_errors_;
    std::vector<Corner> corners_;  // of the polygon being read
};

std::string_view word_at(const char* at, const char* end) {
    const char* stop = at;
    while (stop < end && !ends_word(*stop)) ++stop;
    return {at, static_cast<std::size_t>(stop - at)};
}

ObjRemark ChunkParser::remark(const char* at, std::string what, std::string expected) const {
    const char* stop = std::find(line_start_, end_, '\n');
    const char* text_end = stop;
    while (text_end > line_start_ && is_blank(text_end[-1])) --text_end;
    return {out_.lines,
            static_cast<std::size_t>(at - line_start_) + 1,
            std::max<std::size_t>(word_at(at, stop).size(), 1),
            {line_start_, static_cast<std::size_t>(text_end - line_start_)},
            std::move(what),
            std::move(expected)};
}

// At a backslash: if only the line end follows, goes to that line end and starts the next line.
bool ChunkParser::pass_continuation() {
    const char* newline = p_ + 1;
    while (*newline == '\r') ++newline;
    if (*newline != '\n' || newline >= end_) return false;
    p_ = newline;
    ++out_.lines;
    line_start_ = newline + 1;
    return true;
}

void ChunkParser::parse_line() {
    line_start_ = p_;
    while (is_blank(*p_)) ++p_;
    if (p_[0] == 'v' && is_blank(p_[1]))
        parse_vertex();
    else if (p_[0] == 'f' && is_blank(p_[1]))
        parse_face();
    else if (p_[0] == 'v' && p_[1] == 'n' && is_blank(p_[2]))
        parse_normal();
    else if (p_[0] == '#')
        p_ = static_cast<const char*>(std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_) + 1));
    else if (p_[0] == 'v' && p_[1] == 't' && is_blank(p_[2]))
        skip_line();
    else if (p_[0] != '\n')
        parse_other();
    if (*p_ != '\n') skip_line();
    ++p_;
    ++out_.lines;
}

// Reads the number at p_. Digits that single precision holds exactly, times or by a power of ten that it holds
// exactly, need one rounding only (Clinger 1990); all others go the slow way.
inline bool ChunkParser::parse_number(float& value, const char* name, const char* form) {
    skip_blanks();
    const char* p = p_;
    const bool negative = *p == '-';
    if (negative || *p == '+') ++p;
    const char* begin = p;
    std::uint64_t digits = 0;
    while (is_digit(*p)) digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
    std::ptrdiff_t count = p - begin, decimals = 0;
    if (*p == '.') {
        const char* point = p++;
        while (is_digit(*p)) digits = digits * 10 + static_cast<std::uint64_t>(*p++ - '0');
        decimals = p - point - 1;
        count += decimals;
    }
    if (!ends_word(*p) || count == 0 || count > 18 || decimals > 10 || digits > (1u << 24))
        return parse_number_slowly(value, name, form);
    const float magnitude = static_cast<float>(digits) / powers_of_ten[decimals];
    value = negative ? -magnitude : magnitude;
    p_ = p;
    return true;
}

bool ChunkParser::parse_number_slowly(float& value, const char* name, const char* form) {
    const std::string_view word = word_at(p_, end_);
    if (word.empty()) {
        fail(p_, std::string(name) + " is missing", std::string("expected: ") + form);
        return false;
    }
    const char* begin = word.data();
    const char* stop = begin + word.size();
    if (*begin == '+' && word.size() > 1 && word[1] != '-') ++begin;
    const auto [after, error] = fast_float::from_chars(begin, stop, value);
    if (error != std::errc{} || after != stop) {
        fail(p_, quoted(word) + " is not a number", std::string("expected: ") + form);
        return false;
    }
    if (!std::isfinite(value)) {
        const bool digits = std::ranges::any_of(word, is_digit);
        fail(p_, quoted(word) + (digits ? " is too large" : " is not a finite number"),
             "expected a number from -3.4e38 to 3.4e38");
        return false;
    }
    p_ = stop;
    return true;
}

void ChunkParser::parse_vertex() {
    constexpr const char* form = "v X Y Z";
    ++p_;
    glm::vec3 v;
    if (!parse_number(v.x, "x", form) || !parse_number(v.y, "y", form) || !parse_number(v.z, "z", form)) return;
    skip_blanks();
    float ignored = 0;  // a weight, or a colour
    for (int more = 0; *p_ != '\n'; ++more, skip_blanks()) {
        if (more == 4) return fail(p_, "unexpected " + quoted(word_at(p_, end_)), "expected: v X Y Z [W] [R G B]");
        if (!parse_number(ignored, "weight or colour", "v X Y Z [W] [R G B]")) return;
    }
    out_.positions.push_back(v);
}

void ChunkParser::parse_normal() {
    constexpr const char* form = "vn X Y Z";
    p_ += 2;
    glm::vec3 n;
    if (!parse_number(n.x, "x", form) || !parse_number(n.y, "y", form) || !parse_number(n.z, "z", form)) return;
    skip_blanks();
    if (*p_ != '\n') return fail(p_, "unexpected " + quoted(word_at(p_, end_)), std::string("expected: ") + form);
    out_.normals.push_back(n);
}

// Reads a whole number at p_ as an index into a list of which `count` entries came before in this chunk.
inline bool ChunkParser::parse_index(std::uint32_t& index, std::size_t count, const char* list) {
    const char* begin = p_;
    const bool negative = *begin == '-';
    const char* digits = begin + negative;
    const char* p = digits;
    std::uint64_t value = 0;
    while (is_digit(*p)) value = value * 10 + static_cast<std::uint64_t>(*p++ - '0');
    p_ = p;
    if (p - digits > 19) value = ~std::uint64_t{0};  // it may have wrapped around
    if (p == digits) {
        const char* word = begin;
        while (word > line_start_ && !ends_word(word[-1])) --word;
        fail(word, quoted(word_at(word, end_)) + " is not a corner", "expected: V, V/VT, V//VN or V/VT/VN");
        return false;
    }
    if (value == 0) {
        fail(begin, std::string("index 0: the ") + list + " count from 1", "expected 1 or more, or -1 for the latest");
        return false;
    }
    if (value > most_indexed) {
        fail(begin, "the index " + quoted({begin, static_cast<std::size_t>(p_ - begin)}) + " is out of range",
             std::string("there are not so many ") + list);
        return false;
    }
    const auto small = static_cast<std::uint32_t>(value);
    index = negative ? relative_index | (relative_bias + static_cast<std::uint32_t>(count) - small) : small - 1;
    return true;
}

inline bool ChunkParser::parse_corner(Corner& corner) {
    corner.normal = no_index;
    if (!parse_index(corner.position, out_.positions.size(), "vertices")) return false;
    if (*p_ == '/') {
        ++p_;
        std::uint32_t ignored = 0;  // texture coordinates are not read; their lists are not counted
        if (*p_ != '/' && !parse_index(ignored, 0, "texture coordinates")) return false;
        if (*p_ == '/') {
            ++p_;
            if (!parse_index(corner.normal, out_.normals.size(), "normals")) return false;
        }
    }
    if (ends_word(*p_) || *p_ == '\\') return true;
    const char* word = p_;
    while (word > line_start_ && !ends_word(word[-1])) --word;
    fail(word, quoted(word_at(word, end_)) + " is not a corner", "expected: V, V/VT, V//VN or V/VT/VN");
    return false;
}

void ChunkParser::parse_face() {
    const char* keyword = p_;
    const char* first_line = line_start_;
    ++p_;
    corners_.clear();
    for (skip_blanks(); *p_ != '\n'; skip_blanks()) {
        Corner corner;
        if (!parse_corner(corner)) return;
        corners_.push_back(corner);
        if (corners_.size() > 2 && corners_.size() - 2 > most_faces_) break;  // over the budget already
    }
    if (corners_.size() < 3)
        return fail(line_start_ == first_line ? keyword : line_start_,
                    "a face of " + std::to_string(corners_.size()) + (corners_.size() == 1 ? " corner" : " corners"),
                    "expected three corners or more");
    add_faces();
}

// The polygon as a fan from its first corner.
void ChunkParser::add_faces() {
    const Corner& a = corners_[0];
    for (std::size_t i = 2; i < corners_.size(); ++i) {
        const Corner &b = corners_[i - 1], &c = corners_[i];
        out_.faces.push_back({a.position, b.position, c.position});
        const bool plain = (a.normal & b.normal & c.normal) == no_index;
        if (plain && out_.normal_faces.empty()) continue;
        out_.normal_faces.resize(out_.faces.size() - 1, {no_index, no_index, no_index});
        out_.normal_faces.push_back({a.normal, b.normal, c.normal});
    }
}

void ChunkParser::parse_other() {
    const std::string_view word = word_at(p_, end_);
    if (word == "v" || word == "vn" || word == "f")
        return fail(p_, quoted(word) + " has no values",
                    word == "f" ? "expected: f A B C" : "expected: " + std::string(word) + " X Y Z");
    const bool known = word == "vt" || std::ranges::find(ignored_words, word) != std::end(ignored_words);
    if (!known && out_.unknown_words.empty())
        out_.unknown_words.push_back(
            remark(p_, "unknown statement " + quoted(word), "it is ignored, and so are others"));
    skip_line();
}

// Goes on until the polygon that holds the triangle, then to the corner's word.
ObjRemark ChunkParser::locate(std::size_t face, int corner, bool normal) {
    std::size_t faces_before = 0, lines_before = 0;
    const char* face_line = p_;
    while (p_ < end_ && out_.faces.size() <= face) {
        faces_before = out_.faces.size();
        lines_before = out_.lines;
        face_line = p_;
        parse_line();
    }
    p_ = line_start_ = face_line;
    out_.lines = lines_before;
    skip_blanks();
    ++p_;
    const std::size_t ordinal = corner == 0 ? 0 : face - faces_before + static_cast<std::size_t>(corner);
    for (std::size_t i = 0;; ++i) {
        skip_blanks();
        if (i == ordinal) break;
        while (!ends_word(*p_) && *p_ != '\\') ++p_;
    }
    const char* at = p_;
    if (normal)
        while (at < end_ && !ends_word(*at)) ++at;
    while (normal && at[-1] != '/') --at;
    return remark(at, {}, {});
}

}  // namespace

ObjChunk parse_obj_chunk(std::string_view text, std::uint64_t most_faces, std::uint64_t most_errors) {
    ChunkParser parser(text, most_faces, most_errors);
    parser.parse();
    return std::move(parser.out_);
}

ObjRemark locate_obj_corner(std::string_view text, std::size_t face, int corner, bool normal) {
    return ChunkParser(text, ~std::uint64_t{0}, ~std::uint64_t{0}).locate(face, corner, normal);
}

}  // namespace raywalk
