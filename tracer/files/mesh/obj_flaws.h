// What may be wrong with details of an OBJ file: each flaw costs its detail, and each kind is told of once.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/ground/error.h"

namespace raywalk {

enum class ObjFlaw {
    statement,      // unknown: ignored
    vertex,         // cannot be read: keeps its number, but no face may name it
    extra,          // a weight or a colour is no number: ignored
    normal,         // cannot be read: keeps its number, is as one of length 0
    empty_normal,   // of length 0: corners that name it have none
    corner,         // cannot be read: its face is left out
    few_corners,    // fewer than three: the face is left out
    no_vertex,      // a corner names one that is not there: its face is left out
    lost_vertex,    // a corner names one that cannot be read: its face is left out
    corner_detail,  // what follows the vertex of a corner cannot be read: the vertex counts
    no_normal,      // a corner names one that is not there: it has none
};
inline constexpr std::size_t obj_flaw_kinds = 11;

// A place of the text, and what is wrong there.
struct ObjRemark {
    std::size_t line = 0, column = 0, length = 0;  // line from 0, column from 1
    std::string_view source_line = {};
    std::string what = {}, expected = {};
};

// How often each kind was found, and where first.
class ObjFlaws {
  public:
    // `make_remark` is called for the first of a kind only.
    template <class MakeRemark>
    void add(ObjFlaw kind, const MakeRemark& make_remark) {
        Found& found = found_[static_cast<std::size_t>(kind)];
        if (found.count++ == 0) found.first = make_remark();
    }
    // Those of a piece of text that follows `lines_before` lines.
    void append(ObjFlaws& of_piece, std::size_t lines_before);
    void clear();
    [[nodiscard]] std::size_t count(ObjFlaw kind) const { return found_[static_cast<std::size_t>(kind)].count; }
    // One for each kind, by their places. `vertices` and `normals`: how many the file has.
    [[nodiscard]] std::vector<Diagnostic> warnings(const std::string& file, std::size_t vertices,
                                                   std::size_t normals) const;

  private:
    struct Found {
        std::size_t count = 0;
        ObjRemark first = {};
    };
    std::array<Found, obj_flaw_kinds> found_;
};

}  // namespace raywalk
