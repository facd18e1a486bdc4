// Wavefront OBJ -> indexed triangle mesh: v, vn, f (v, v/vt, v//vn, v/vt/vn, polygons, negative indices).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "tracer/ground/error.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// Throws InputError (with file:line:column) on a malformed file, on indices out of range, on numbers that are not
// finite, on a file without faces and on a broken budget; `where` is the place that named a file which cannot be read.
// Polygons become fans from their first vertex. Corners that name a normal of length 0 have none (-1), with a warning.
// Parsed in pieces by all threads; the result is the same for any number of them.
TriangleMesh read_obj(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings,
                      const SourceLocation& where = {});
TriangleMesh parse_obj(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                       std::vector<Diagnostic>& warnings);

}  // namespace raywalk
