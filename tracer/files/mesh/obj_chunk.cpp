#include "tracer/files/mesh/obj_chunk.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tracer/files/blank.h"
#include "tracer/files/decimal.h"
#include "tracer/files/mesh/obj_cursor.h"
#include "tracer/files/mesh/obj_words.h"
#include "tracer/ground/error.h"
#include "tracer/ground/utf8.h"

namespace raywalk {

namespace {

class ChunkParser : ObjCursor {
  public:
    // `into` is empty.
    ChunkParser(std::string_view text, const ObjReading& reading, ObjChunk& into)
        : ObjCursor(text, into.flaws), out_(into), reading_(reading), has_origin_(reading.origin != glm::dvec3(0)) {}

    void parse() {
        while (p_ < end_ && out_.faces.size() <= reading_.most_faces) parse_line();
        out_.lines = lines_;
        out_.lone_returns = lone_returns_;
    }

  private:
    struct Corner {
        std::uint32_t position, normal;
    };

    void parse_line();
    void parse_vertex();
    void parse_vertex_extras();
    void lose_vertex();
    void parse_normal();
    void parse_face();
    void parse_other(std::string_view word);
    bool parse_moved_vertex(glm::vec3& v);
    template <class Vector>
    bool parse_coordinates(Vector& v, ObjFlaw flaw);
    template <class Real>
    bool parse_number(Real& value, const char* name, ObjFlaw flaw);
    static const char* read_plain_corner(const char* p, Corner& corner);
    bool parse_plain_face();
    bool parse_corner(Corner& corner);
    void parse_corner_details(std::string_view word, std::string_view details, Corner& corner);
    bool resolve(const WrittenIndex& index, std::size_t count, std::uint32_t& into) const;
    bool is_there(const char* word, Corner& corner);
    void add_normal(glm::vec3 n);
    void add_face(const Corner& a, const Corner& b, const Corner& c);
    void drop_faces_from(std::size_t face);

    ObjChunk& out_;
    const ObjReading& reading_;
    const bool has_origin_;
};

void ChunkParser::parse_line() {
    line_start_ = p_;
    while (is_blank(*p_)) ++p_;
    if (p_[0] == 'v' && is_blank(p_[1])) {
        parse_vertex();
    } else if (p_[0] == 'f' && is_blank(p_[1])) {
        parse_face();
    } else if (p_[0] == 'v' && p_[1] == 'n' && is_blank(p_[2])) {
        parse_normal();
    } else if (p_[0] == '#') {
        skip_to_line_end();
    } else if (p_[0] == 'v' && p_[1] == 't' && is_blank(p_[2])) {
        skip_texture_coordinates();
    } else if (p_[0] != '\n') {
        const std::string_view word = word_at(p_);
        if (word.starts_with(byte_order_mark)) {  // of the file, or of one that was put behind another
            p_ += byte_order_mark.size();
            return;  // the line begins here
        }
        parse_other(word);
    }
    if (*p_ != '\n') skip_line();
    ++p_;
    ++lines_;
}

// Reads three numbers, with p_ in a register between those that are written as most are.
template <class Vector>
inline bool ChunkParser::parse_coordinates(Vector& v, ObjFlaw flaw_of_one) {
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
        if (!parse_number(v[axis], names[axis], flaw_of_one)) return false;
        p = p_;
    }
    p_ = p;
    return true;
}

template <class Real>
bool ChunkParser::parse_number(Real& value, const char* name, ObjFlaw flaw_of_one) {
    const char* expected = flaw_of_one == ObjFlaw::normal  ? "expected: vn X Y Z"
                           : flaw_of_one == ObjFlaw::extra ? "expected: v X Y Z [W] [R G B]"
                                                           : "expected: v X Y Z";
    skip_blanks();
    if (at_end_of_values()) {
        flaw(flaw_of_one, p_, 1, std::string(name) + " is missing", expected);
        return false;
    }
    const std::string_view word = value_at(p_);
    const char* begin = word.data();
    const char* stop = begin + word.size();
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') ++begin;
    const auto [after, error] = fast_float::from_chars(begin, stop, value);
    if (error != std::errc{} || after != stop) {
        flaw(flaw_of_one, p_, 0, quoted(word_at(p_)) + " is not a number", expected);
        return false;
    }
    if (!std::isfinite(static_cast<float>(value))) {
        const bool digits = std::ranges::any_of(word, is_digit);
        flaw(flaw_of_one, p_, word.size(), quoted(word) + (digits ? " is too large" : " is not a finite number"),
             "expected a number from -3.4e38 to 3.4e38");
        return false;
    }
    p_ = stop;
    return true;
}

void ChunkParser::parse_vertex() {
    ++p_;
    glm::vec3 v;
    if (has_origin_ ? !parse_moved_vertex(v) : !parse_coordinates(v, ObjFlaw::vertex)) return lose_vertex();
    out_.positions.push_back(v);
    skip_blanks();
    if (!at_end_of_values()) parse_vertex_extras();
}

bool ChunkParser::parse_moved_vertex(glm::vec3& v) {
    glm::dvec3 read;
    if (!parse_coordinates(read, ObjFlaw::vertex)) return false;
    v = glm::vec3(read - reading_.origin);
    return true;
}

// A weight, a colour, or both; nothing is made of them, nor of what may follow.
void ChunkParser::parse_vertex_extras() {
    float ignored = 0;
    for (int count = 0; count < 4 && !at_end_of_values(); ++count, skip_blanks())
        if (!parse_number(ignored, "weight or colour", ObjFlaw::extra)) return;
}

// The vertices behind it keep their numbers.
void ChunkParser::lose_vertex() {
    out_.lost_vertices.push_back(static_cast<std::uint32_t>(out_.positions.size()));
    out_.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
}

void ChunkParser::parse_normal() {
    p_ += 2;
    glm::vec3 n;
    if (parse_coordinates(n, ObjFlaw::normal))
        add_normal(n);
    else
        out_.normals.emplace_back(0);
}

// One whose square would leave single precision is brought to a length near 1.
inline void ChunkParser::add_normal(glm::vec3 n) {
    constexpr float small = 1e-15f, large = 1e15f;
    const float largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    if (largest == 0)
        flaw(ObjFlaw::empty_normal, line_start_, 1, {}, "corners that name it get one from the faces around them");
    else if (!(largest >= small && largest <= large))
        n = glm::vec3(glm::dvec3(n) / static_cast<double>(largest));
    out_.normals.push_back(n);
}

// The index into a list of which `count` entries came before in this chunk. False if no list has so many.
bool ChunkParser::resolve(const WrittenIndex& index, std::size_t count, std::uint32_t& into) const {
    if (index.value == 0 || index.value > most_indexed) return false;
    const auto value = static_cast<std::uint32_t>(index.value);
    into = index.negative ? relative_index | (relative_bias + static_cast<std::uint32_t>(count) - value) : value - 1;
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

// Any other corner: V, V/VT, V//VN, V/VT/VN, and "1/", "1//", "1/1/".
bool ChunkParser::parse_corner(Corner& corner) {
    corner.normal = no_index;
    const std::string_view word = value_at(p_);
    const WrittenIndex vertex = read_index(word);
    if (vertex.length == 0 || (vertex.length < word.size() && word[vertex.length] != '/')) {
        flaw(ObjFlaw::corner, p_, 0, quoted(word_at(p_)) + " is not a corner", "expected: V, V/VT, V//VN or V/VT/VN");
        return false;
    }
    if (!resolve(vertex, out_.positions.size(), corner.position)) {
        no_such(ObjFlaw::no_vertex, word.substr(0, vertex.length));
        return false;
    }
    if (vertex.length < word.size()) parse_corner_details(word, word.substr(vertex.length + 1), corner);
    p_ += word.size();
    return true;
}

// What follows the first slash. Texture coordinates are not read; their lists are not counted.
void ChunkParser::parse_corner_details(std::string_view word, std::string_view details, Corner& corner) {
    const std::size_t slash = details.find('/');
    const std::string_view texture = details.substr(0, slash);
    bool good = read_index(texture).length == texture.size();
    if (slash != std::string_view::npos && slash + 1 < details.size()) {
        const std::string_view text = details.substr(slash + 1);
        const WrittenIndex normal = read_index(text);
        const bool ends = normal.length == text.size();
        good = good && ends;
        if (normal.length > 0 && (ends || text[normal.length] == '/') &&
            !resolve(normal, out_.normals.size(), corner.normal)) {
            corner.normal = no_index;
            no_such(ObjFlaw::no_normal, text.substr(0, normal.length));
        }
    }
    if (!good)
        flaw(ObjFlaw::corner_detail, word.data(), word.size(), quoted(word) + " is not a corner",
             "expected: V, V/VT, V//VN or V/VT/VN");
}

// In a second reading: may a face name the vertex of this corner? A normal that is not there is taken from the corner.
bool ChunkParser::is_there(const char* word, Corner& corner) {
    const ObjCensus& census = *reading_.census;
    const auto index_after = [](const char* at) { return std::string_view(at, read_index(value_at(at)).length); };
    const std::uint32_t vertex = absolute_index(corner.position, reading_.vertices_before);
    if (vertex >= census.vertices) {
        no_such(ObjFlaw::no_vertex, index_after(word));
        return false;
    }
    if (std::ranges::binary_search(census.lost_vertices, vertex)) {
        flaw(ObjFlaw::lost_vertex, word, index_after(word).size(),
             "vertex " + std::to_string(vertex + 1) + " cannot be read", {});
        return false;
    }
    if (corner.normal != no_index && absolute_index(corner.normal, reading_.normals_before) >= census.normals) {
        const std::string_view text = value_at(word);
        no_such(ObjFlaw::no_normal, index_after(word + text.find('/', text.find('/') + 1) + 1));
        corner.normal = no_index;
    }
    return true;
}

// Reads what most lines of most files are: three such corners, or four, with a blank before each and nothing behind.
inline bool ChunkParser::parse_plain_face() {
    Corner corners[4];
    const char* p = p_ + 1;
    for (int i = 0; i < 3; ++i)
        if (*p != ' ' || (p = read_plain_corner(p + 1, corners[i])) == nullptr) return false;
    const bool quad = *p == ' ' && p[1] > ' ';
    if (quad && (p = read_plain_corner(p + 1, corners[3])) == nullptr) return false;
    if (*p == '\r') ++p;
    if (*p != '\n') return false;
    if (quad) out_.polygons.add(out_.faces.size(), 4);
    add_face(corners[0], corners[1], corners[2]);
    if (quad) add_face(corners[0], corners[2], corners[3]);
    p_ = p;
    return true;
}

// A polygon, as a fan from its first corner.
void ChunkParser::parse_face() {
    if (reading_.census == nullptr && parse_plain_face()) return;
    const char* keyword = p_;
    const char* first_line = line_start_;
    const std::size_t faces_before = out_.faces.size();
    Corner first{}, previous{};
    std::size_t count = 0;
    for (++p_, skip_blanks(); !at_end_of_values(); skip_blanks()) {
        Corner corner{};
        const char* word = p_;
        const char* after = read_plain_corner(p_, corner);
        const bool plain = after != nullptr && ends_word(*after);
        if (plain) p_ = after;
        if ((!plain && !parse_corner(corner)) || (reading_.census != nullptr && !is_there(word, corner)))
            return drop_faces_from(faces_before);
        if (count == 0) first = corner;
        if (count >= 2) add_face(first, previous, corner);
        previous = corner;
        if (++count > 2 && count - 2 > reading_.most_faces) return;  // over the budget already
    }
    if (count > 3) out_.polygons.add(faces_before, static_cast<std::uint32_t>(count));
    if (count < 3)
        flaw(ObjFlaw::few_corners, line_start_ == first_line ? keyword : line_start_, 0,
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

void ChunkParser::drop_faces_from(std::size_t face) {
    out_.faces.resize(face);
    out_.normal_faces.resize(std::min(out_.normal_faces.size(), face));
}

void ChunkParser::parse_other(std::string_view word) {
    if (word == "v") {
        flaw(ObjFlaw::vertex, p_, 0, "'v' has no values", "expected: v X Y Z");
        lose_vertex();
    } else if (word == "vn") {
        flaw(ObjFlaw::normal, p_, 0, "'vn' has no values", "expected: vn X Y Z");
        out_.normals.emplace_back(0);
    } else if (word == "f") {
        flaw(ObjFlaw::few_corners, p_, 0, "a face of 0 corners", "expected three corners or more");
    } else if (word == "vt" || is_number_statement(word)) {
        return skip_line();
    } else if (!is_name_statement(word)) {
        flaw(ObjFlaw::statement, p_, 0, "unknown statement " + quoted(word),
             "expected one of OBJ files, such as v, vn or f");
    }
    skip_to_line_end();
}

}  // namespace

void ObjChunk::clear() {
    positions.clear();
    normals.clear();
    faces.clear();
    normal_faces.clear();
    polygons.clear();
    lost_vertices.clear();
    lines = 0;
    flaws.clear();
    lone_returns = false;
}

void parse_obj_chunk(std::string_view text, const ObjReading& reading, ObjChunk& into) {
    into.clear();
    ChunkParser(text, reading, into).parse();
}

}  // namespace raywalk
