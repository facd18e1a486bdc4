#include "tracer/compiled/kdtree/clip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracer/compiled/shape_bounds.h"

namespace raywalk::kd {

namespace {

using Point = std::array<double, 3>;

// A triangle cut by seven planes has up to ten corners; the rest is for what rounding may make of slivers.
struct Polygon {
    static constexpr int capacity = 16;
    std::array<Point, capacity> corner;
    int count = 0;
};

// Where the edge from a to b meets the plane; exactly on it along the axis, between a and b along the others.
Point meeting(const Point& a, const Point& b, int axis, double plane) {
    const double t = (plane - a[axis]) / (b[axis] - a[axis]);
    Point p;
    for (int k = 0; k < 3; ++k) p[k] = std::clamp(a[k] + t * (b[k] - a[k]), std::min(a[k], b[k]), std::max(a[k], b[k]));
    p[axis] = plane;
    return p;
}

// Sutherland and Hodgman: keeps what is at or beyond the plane in the direction of `sign`.
Polygon clipped(const Polygon& polygon, int axis, double sign, double plane) {
    Polygon result;
    for (int i = 0; i < polygon.count; ++i) {
        const Point& a = polygon.corner[i];
        const Point& b = polygon.corner[i + 1 < polygon.count ? i + 1 : 0];
        if (result.count + 2 > Polygon::capacity) return polygon;  // keeping too much is safe
        const bool a_inside = sign * (a[axis] - plane) >= 0, b_inside = sign * (b[axis] - plane) >= 0;
        if (a_inside) result.corner[result.count++] = a;
        if (a_inside != b_inside) result.corner[result.count++] = meeting(a, b, axis, plane);
    }
    return result;
}

Polygon inside(const TriangleCorners& triangle, const Bounds& box) {
    Polygon polygon;
    polygon.count = 3;
    for (int i = 0; i < 3; ++i) polygon.corner[i] = {triangle.p[i].x, triangle.p[i].y, triangle.p[i].z};
    const Bounds whole = bounds_of(triangle);
    for (int axis = 0; axis < 3; ++axis) {
        if (whole.lower[axis] < box.lower[axis]) polygon = clipped(polygon, axis, 1, box.lower[axis]);
        if (whole.upper[axis] > box.upper[axis]) polygon = clipped(polygon, axis, -1, box.upper[axis]);
    }
    return polygon;
}

Bounds intersection(const Bounds& a, const Bounds& b) {
    return {glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
}

Bounds bounds_of(const Polygon& polygon) {
    Point lower = polygon.corner[0], upper = polygon.corner[0];
    for (int i = 1; i < polygon.count; ++i)
        for (int k = 0; k < 3; ++k) {
            lower[k] = std::min(lower[k], polygon.corner[i][k]);
            upper[k] = std::max(upper[k], polygon.corner[i][k]);
        }
    return {{round_down(lower[0]), round_down(lower[1]), round_down(lower[2])},
            {round_up(upper[0]), round_up(upper[1]), round_up(upper[2])}};
}

// The box's halves on either side of the plane.
Parts halves(const Bounds& box, int axis, float plane) {
    Parts parts{box, box};
    parts.lower.upper[axis] = std::min(box.upper[axis], plane);
    parts.upper.lower[axis] = std::max(box.lower[axis], plane);
    return parts;
}

// What is left of a box after trimming; a box that rounding turned inside out is flat.
Bounds trimmed(const Bounds& part, const Bounds& half) {
    Bounds box = intersection(part, half);
    for (int k = 0; k < 3; ++k)
        if (box.lower[k] > box.upper[k])
            box.lower[k] = box.upper[k] = std::clamp(box.lower[k], half.lower[k], half.upper[k]);
    return box;
}

}  // namespace

Parts split_triangle(const TriangleCorners& triangle, const Bounds& box, int axis, float plane) {
    const Parts half = halves(box, axis, plane);
    const Polygon polygon = inside(triangle, box);
    if (polygon.count == 0) return half;  // rounding only: the caller knows that the shape is here
    const double margin = rounding_margin * largest_magnitude(box);
    const Polygon low = clipped(polygon, axis, -1, plane + margin);
    const Polygon high = clipped(polygon, axis, 1, plane - margin);
    Parts parts;
    if (low.count > 0) parts.lower = trimmed(bounds_of(low), half.lower);
    if (high.count > 0) parts.upper = trimmed(bounds_of(high), half.upper);
    return parts;
}

namespace {

// Box of the sphere's surface within `cell`; empty when the surface is certainly outside.
Bounds surface_bounds(const SphereShape& sphere, const Bounds& cell) {
    const double radius = std::fabs(sphere.radius);
    double nearest[3], farthest = 0, scale = radius;  // squared distances of the cell from the centre, by axis
    for (int k = 0; k < 3; ++k) {
        const double c = sphere.center[k], below = cell.lower[k] - c, above = c - cell.upper[k];
        const double near = std::max({below, above, 0.0}), far = std::max(std::fabs(below), std::fabs(above));
        nearest[k] = near * near;
        farthest += far * far;
        scale = std::max(scale, std::fabs(c));
    }
    const double margin = 4 * rounding_margin * scale, outer = radius + margin;
    if (radius > margin && farthest < (radius - margin) * (radius - margin)) return {};
    Bounds box;
    for (int k = 0; k < 3; ++k) {
        const double room = outer * outer - nearest[(k + 1) % 3] - nearest[(k + 2) % 3];
        if (room < 0) return {};
        const double reach = std::sqrt(room) + margin;
        box.lower[k] = round_down(sphere.center[k] - reach);
        box.upper[k] = round_up(sphere.center[k] + reach);
    }
    box = intersection(box, cell);
    return box.empty() ? Bounds{} : box;
}

}  // namespace

Parts split_sphere(const SphereShape& sphere, const Bounds& box, int axis, float plane) {
    const Parts half = halves(box, axis, plane);
    return {surface_bounds(sphere, half.lower), surface_bounds(sphere, half.upper)};
}

}  // namespace raywalk::kd
