// OBJ files of every kind of line, random but for their seed, and a reader of them that goes word by word.
#pragma once

#include <cstddef>
#include <string>

#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// About so many bytes. Polygons of more than three corners are convex.
std::string random_obj(unsigned seed, std::size_t bytes);

// The same mesh as parse_obj makes of it: what cannot be read, or names what is not there, is left out.
TriangleMesh parse_naively(const std::string& text);

}  // namespace raywalk
