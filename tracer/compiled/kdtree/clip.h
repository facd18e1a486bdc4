// "Perfect splits": what of a shape lies on either side of a split plane, as boxes (Wald and Havran 2006, 2.2).
#pragma once

#include "tracer/compiled/hierarchy.h"

namespace raywalk::kd {

// Boxes of the parts of a shape in `box`, which contains all of the shape that matters, below and above the plane.
// Each is empty only when the shape certainly stays a rounding margin away from that side; otherwise it contains the
// part, lies in `box` and ends at the plane.
struct Parts {
    Bounds lower, upper;
};

Parts split_triangle(const TriangleCorners& triangle, const Bounds& box, int axis, float plane);

// The sphere is its surface: a cell deep inside holds none of it.
Parts split_sphere(const SphereShape& sphere, const Bounds& box, int axis, float plane);

}  // namespace raywalk::kd
