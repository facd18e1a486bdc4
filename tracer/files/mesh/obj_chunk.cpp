#include "tracer/files/mesh/obj_chunk.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "tracer/files/blank.h"
#include "tracer/files/decimal.h"
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

constexpr bool ends_word(char c) { return static_cast<unsigned char>(c) <= ' ' && (is_blank(c) || c == '\n'); }

class ChunkParser {
  public:
    // `into` is empty.
    ChunkParser(std::string_view text, std::uint64_t most_faces, std::uint64_t most_errors, ObjChunk& into)
        : out_(into),
          p_(text.data()),
          end_(text.data() + text.size()),
          line_start_(p_),
          most_faces_(most_faces),
          most_errors_(most_errors) {}

    void parse() {
        while (p_ < end_ && out_.faces.size() <= most_faces_ && out_.errors.size() < most_errors_) parse_line();
    }
    ObjRemark locate(std::size_t face, int corner, bool normal);

  private:
    struct Corner {
        std::uint32_t position, normal;
    };

    void parse_line();
    void parse_vertex();
    void parse_normal();
    void parse_face();
    void parse_other();
    bool parse_coordinates(glm::vec3& v, const char* form);
    bool parse_number(float& value, const char* name, const char* form);
    static const char* read_plain_corner(const char* p, Corner& corner);
    bool parse_plain_triangle();
    bool parse_corner(Corner& corner);
    bool parse_index(std::uint32_t& index, std::size_t count, const char* list);
    void add_normal(glm::vec3 n);
    void add_face(const Corner& a, const Corner& b, const Corner& c);

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

    ObjChunk& out_;
    const char* p_;
    const char* end_;         // a newline stands there
    const char* line_start_;  // of the line that p_ is in
    std::uint64_t most_faces_, most_errors_;
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

// Reads three numbers, with p_ in a register between those that are written as most are.
inline bool ChunkParser::parse_coordinates(glm::vec3& v, const char* form) {
    constexpr const char* names[] = {"x", "y", "z"};
    const char* p = p_;
    for (int axis = 0; axis < 3; ++axis) {
        while (is_blank(*p)) ++p;
        const char* after = read_decimal(p, v[axis]);
        if (after != nullptr && ends_word(*after)) {
            p = after;
            continue;
        }
        p_ = p;
        if (!parse_number(v[axis], names[axis], form)) return false;
        p = p_;
    }
    p_ = p;
    return true;
}

bool ChunkParser::parse_number(float& value, const char* name, const char* form) {
    skip_blanks();
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
    if (!parse_coordinates(v, form)) return;
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
    if (!parse_coordinates(n, form)) return;
    skip_blanks();
    if (*p_ != '\n') return fail(p_, "unexpected " + quoted(word_at(p_, end_)), std::string("expected: ") + form);
    add_normal(n);
}

// One whose square would leave single precision is brought to a length near 1.
inline void ChunkParser::add_normal(glm::vec3 n) {
    constexpr float small = 1e-15f, large = 1e15f;
    const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    if (largest == 0)
        ++out_.empty_normals;
    else if (!(largest >= small && largest <= large))
        n = glm::vec3(glm::dvec3(n) / static_cast<double>(largest));
    out_.normals.push_back(n);
}

// Reads a whole number at p_ as an index into a list of which `count` entries came before in this chunk.
bool ChunkParser::parse_index(std::uint32_t& index, std::size_t count, const char* list) {
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

// The corner at p, and where it ends, if it is written with positive indices of few digits; nullptr otherwise.
inline const char* ChunkParser::read_plain_corner(const char* p, Corner& corner) {
    std::uint32_t position = 0, texture = 1, normal = no_index + 1;
    p = read_short_whole(p, position);
    if (p == nullptr) return nullptr;
    if (*p == '/') {
        ++p;
        if (*p != '/' && (p = read_short_whole(p, texture)) == nullptr) return nullptr;
        if (*p == '/' && ((p = read_short_whole(p + 1, normal)) == nullptr || normal == 0)) return nullptr;
    }
    if (position == 0 || texture == 0) return nullptr;
    corner = {position - 1, normal - 1};
    return p;
}

bool ChunkParser::parse_corner(Corner& corner) {
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

// Reads what most lines of most files are: three such corners with a blank before each and nothing behind.
inline bool ChunkParser::parse_plain_triangle() {
    Corner corners[3];
    const char* p = p_ + 1;
    for (Corner& corner : corners) {
        if (*p != ' ' || (p = read_plain_corner(p + 1, corner)) == nullptr) return false;
    }
    if (*p != '\n') return false;
    add_face(corners[0], corners[1], corners[2]);
    p_ = p;
    return true;
}

// A polygon, as a fan from its first corner.
void ChunkParser::parse_face() {
    if (parse_plain_triangle()) return;
    const char* keyword = p_;
    const char* first_line = line_start_;
    const std::size_t faces_before = out_.faces.size();
    Corner first{}, previous{};
    std::size_t count = 0;
    for (++p_, skip_blanks(); *p_ != '\n'; skip_blanks()) {
        Corner corner{};
        if (const char* after = read_plain_corner(p_, corner); after != nullptr && ends_word(*after)) {
            p_ = after;
        } else if (!parse_corner(corner)) {
            out_.faces.resize(faces_before);
            out_.normal_faces.resize(std::min(out_.normal_faces.size(), faces_before));
            return;
        }
        if (count == 0) first = corner;
        if (count >= 2) add_face(first, previous, corner);
        previous = corner;
        if (++count > 2 && count - 2 > most_faces_) break;  // over the budget already
    }
    if (count < 3)
        fail(line_start_ == first_line ? keyword : line_start_,
             "a face of " + std::to_string(count) + (count == 1 ? " corner" : " corners"),
             "expected three corners or more");
}

inline void ChunkParser::add_face(const Corner& a, const Corner& b, const Corner& c) {
    out_.faces.push_back({a.position, b.position, c.position});
    const bool plain = (a.normal & b.normal & c.normal) == no_index;
    if (plain && out_.normal_faces.empty()) return;
    out_.normal_faces.resize(out_.faces.size() - 1, {no_index, no_index, no_index});
    out_.normal_faces.push_back({a.normal, b.normal, c.normal});
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

void ObjChunk::clear() {
    positions.clear();
    normals.clear();
    faces.clear();
    normal_faces.clear();
    lines = empty_normals = 0;
    errors.clear();
    unknown_words.clear();
}

void parse_obj_chunk(std::string_view text, std::uint64_t most_faces, std::uint64_t most_errors, ObjChunk& into) {
    into.clear();
    ChunkParser(text, most_faces, most_errors, into).parse();
}

ObjRemark locate_obj_corner(std::string_view text, std::size_t face, int corner, bool normal) {
    ObjChunk chunk;
    return ChunkParser(text, ~std::uint64_t{0}, ~std::uint64_t{0}, chunk).locate(face, corner, normal);
}

}  // namespace raywalk
