// Boxes of single shapes, and the small safety margins that keep rounding from losing one.
#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/common.hpp>

#include "tracer/compiled/hierarchy.h"

namespace raywalk {

// Relative room for the rounding of single-precision ray tests: 4 units in the last place.
inline constexpr double rounding_margin = 0x1p-21;

inline bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Shapes that are not finite can never be hit; the hierarchies leave them out.
inline bool finite(const TriangleCorners& t) { return finite(t.p[0]) && finite(t.p[1]) && finite(t.p[2]); }
inline bool finite(const SphereShape& s) { return finite(s.center) && std::isfinite(s.radius); }

inline float largest_magnitude(const Bounds& box) {
    const glm::vec3 m = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    return std::max({m.x, m.y, m.z});
}

// The float next to `value` downwards or upwards that is not above or below it; never infinite.
inline float round_down(double value) {
    if (value <= -double{FLT_MAX}) return -FLT_MAX;
    if (value >= double{FLT_MAX}) return FLT_MAX;
    const float f = static_cast<float>(value);
    return double{f} > value ? std::nextafter(f, -FLT_MAX) : f;
}
inline float round_up(double value) { return -round_down(-value); }

inline Bounds widened(const Bounds& box, double margin) {
    Bounds wide;
    for (int axis = 0; axis < 3; ++axis) {
        wide.lower[axis] = round_down(box.lower[axis] - margin);
        wide.upper[axis] = round_up(box.upper[axis] + margin);
    }
    return wide;
}

// The box of a scene with a hair of room, so that no shape lies in its faces and no side of it is 0.
inline Bounds with_margin(const Bounds& scene) {
    return widened(scene, 2 * rounding_margin * largest_magnitude(scene) + double{FLT_MIN});
}

// Half the surface area in double precision, in which no finite box overflows.
inline double half_area(const Bounds& box) {
    const double x = double{box.upper.x} - box.lower.x, y = double{box.upper.y} - box.lower.y,
                 z = double{box.upper.z} - box.lower.z;
    return x * y + y * z + z * x;
}

// Exact: an axis-aligned triangle has a flat box.
inline Bounds bounds_of(const TriangleCorners& t) {
    // Adding +0 turns -0 into +0, so that equal coordinates have equal bits.
    return {glm::min(glm::min(t.p[0], t.p[1]), t.p[2]) + 0.0f, glm::max(glm::max(t.p[0], t.p[1]), t.p[2]) + 0.0f};
}

inline Bounds bounds_of(const SphereShape& s) {
    const double radius = std::fabs(s.radius);
    Bounds box;
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = radius + rounding_margin * (std::fabs(s.center[axis]) + radius);
        box.lower[axis] = round_down(s.center[axis] - reach) + 0.0f;
        box.upper[axis] = round_up(s.center[axis] + reach) + 0.0f;
    }
    return box;
}

}  // namespace raywalk
