// The invariants of both hierarchies.
#pragma once

#include <string>

#include "tracer/compiled/hierarchy.h"

namespace raywalk {

// Checks every invariant (each shape in each leaf that it touches, child boxes inside parents, indices in range,
// padding lanes empty); returns what is wrong, empty when nothing is.
std::string validate(const Hierarchy& hierarchy, const Shapes& shapes);

}  // namespace raywalk
