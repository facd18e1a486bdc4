// One piece of an OBJ file, parsed on its own: what obj_reader puts together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raywalk {

// A corner's index before the whole file is known: from 0 in the file's list, or, with this bit, relative: bias more
// than the place in the list where the chunk starts.
inline constexpr std::uint32_t relative_index = 0x8000'0000u;
inline constexpr std::uint32_t relative_bias = 0x4000'0000u;
inline constexpr std::uint32_t no_index = 0xFFFF'FFFFu;
// Longer lists of vertices or normals would not fit beside the bit.
inline constexpr std::uint64_t most_indexed = 0x3FFF'FFFFu;

// A mistake, or a warning, at a place of a chunk.
struct ObjRemark {
    std::size_t line, column, length;  // line from 0 in the chunk, column from 1
    std::string_view source_line;
    std::string what, expected;
};

struct ObjChunk {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // of lengths whose squares single precision holds, or 0
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::vector<std::array<std::uint32_t, 3>> normal_faces;  // empty, or one per face; no_index where a corner has none
    std::size_t lines = 0;
    std::size_t empty_normals = 0;  // normals of length 0
    std::vector<ObjRemark> errors;
    std::vector<ObjRemark> unknown_words;  // the first, if any

    void clear();  // the lists keep their memory for the next chunk
};

// Parses whole lines into `into`, whose memory is used again. The newlines of FileBytes must follow the last text in
// memory. Stops after `most_errors` errors or more than `most_faces` faces.
void parse_obj_chunk(std::string_view text, std::uint64_t most_faces, std::uint64_t most_errors, ObjChunk& into);

// Where corner 0..2 of triangle number `face` of a chunk stands; of its `normal`, if so asked.
ObjRemark locate_obj_corner(std::string_view text, std::size_t face, int corner, bool normal);

}  // namespace raywalk
