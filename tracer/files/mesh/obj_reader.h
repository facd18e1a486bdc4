// Wavefront OBJ -> indexed triangle mesh: v, vn, f (v, v/vt, v//vn, v/vt/vn, polygons, negative indices).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "tracer/scene/limits.h"
#include "tracer/ground/error.h"

namespace raywalk {

struct TriangleMesh {
    std::vector<glm::vec3> positions;                       // as in the file, not moved or scaled
    std::vector<std::array<std::uint32_t, 3>> faces;        // indices into positions
    std::vector<glm::vec3> normals;                         // as in the file (unit length not promised); may be empty
    std::vector<std::array<std::int32_t, 3>> normal_faces;  // indices into normals or -1; empty, or one per face
};

// Throws InputError (with file:line:column) on a malformed file, on indices out of range, on numbers that are not
// finite, on a file without faces and on a broken budget; `where` is the place that named a file which cannot be read.
// Polygons become fans from their first vertex. Corners that name a normal of length 0 have none (-1), with a warning.
// Parsed in pieces by all threads; the result is the same for any number of them.
TriangleMesh read_obj(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings,
                      const SourceLocation& where = {});
TriangleMesh parse_obj(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                       std::vector<Diagnostic>& warnings);

}  // namespace raywalk
