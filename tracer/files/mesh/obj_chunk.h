// One piece of an OBJ file, parsed on its own: what obj_reader puts together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "tracer/files/mesh/obj_flaws.h"
#include "tracer/files/mesh/polygons.h"

namespace raywalk {

// A corner's index before the whole file is known: from 0 in the file's list, or, with this bit, relative: bias more
// than the place in the list where the chunk starts.
inline constexpr std::uint32_t relative_index = 0x8000'0000u;
inline constexpr std::uint32_t relative_bias = 0x4000'0000u;
inline constexpr std::uint32_t no_index = 0xFFFF'FFFFu;
// Longer lists of vertices or normals would not fit beside the bit.
inline constexpr std::uint64_t most_indexed = 0x3FFF'FFFFu;

// An index of a chunk as one into the whole file's list, in which `start` entries come before the chunk. What would be
// below 0 is larger than any list is long.
inline std::uint32_t absolute_index(std::uint32_t index, std::size_t start) {
    return index & relative_index ? static_cast<std::uint32_t>(start) + (index & ~relative_index) - relative_bias
                                  : index;
}

// What a first reading of the whole file found out: with it, a second one tests every corner.
struct ObjCensus {
    std::size_t vertices, normals;
    std::vector<std::uint32_t> lost_vertices;  // that cannot be read; ascending
};

// How to read a chunk.
struct ObjReading {
    std::uint64_t most_faces;
    glm::dvec3 origin = glm::dvec3(0);  // taken off each vertex before it is rounded
    const ObjCensus* census = nullptr;  // and then how many of each come before the chunk
    std::size_t vertices_before = 0, normals_before = 0;
};

struct ObjChunk {
    std::vector<glm::vec3> positions;  // NaN where one cannot be read
    std::vector<glm::vec3> normals;    // of lengths whose squares single precision holds, or 0
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::vector<std::array<std::uint32_t, 3>> normal_faces;  // empty, or one per face; no_index where a corner has none
    PolygonRuns polygons;                                    // of more than three corners, as fans among the faces
    std::vector<std::uint32_t> lost_vertices;                // among the positions
    std::size_t lines = 0;
    ObjFlaws flaws;
    bool lone_returns = false;  // a carriage return that ends a line was seen: the lines are others

    void clear();  // the lists keep their memory for the next chunk
};

// Parses whole lines into `into`, whose memory is used again. The newlines of FileBytes must follow the last text in
// memory. Stops after more than reading.most_faces faces.
void parse_obj_chunk(std::string_view text, const ObjReading& reading, ObjChunk& into);

}  // namespace raywalk
