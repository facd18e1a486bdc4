// Wavefront OBJ -> indexed triangle mesh: v, vn, f (v, v/vt, v//vn, v/vt/vn, polygons, negative indices).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "tracer/ground/error.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// What is wrong with a detail costs that detail (a face that names a vertex which is not there is left out, a normal
// that cannot be read is taken from the faces) and is warned of once for each kind, with the first place. Throws
// InputError where no picture is left: no faces, or a broken budget; `where` is the place that named a file which
// cannot be read. Convex polygons become fans from their first corner. Vertices that no face names are left out. Parsed
// in pieces by all threads; the result is the same for any number of them.
TriangleMesh read_obj(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings,
                      const SourceLocation& where = {}, const FileOpener& open = open_file);
TriangleMesh parse_obj(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                       std::vector<Diagnostic>& warnings);

}  // namespace raywalk
