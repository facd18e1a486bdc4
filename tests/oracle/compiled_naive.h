// Naive twins for the hierarchies: a loop over all shapes, and plain traversals, in double precision.
#pragma once

#include <cstdint>

#include "tests/oracle/compiled_shapes.h"
#include "tracer/compiled/hierarchy.h"

namespace raywalk::testing {

struct NaiveRay {
    double origin[3], direction[3];
};

struct NaiveHit {
    double t = 1e300;
    std::int64_t id = -1;  // triangles first, then spheres; of equals the smallest
    friend bool operator==(const NaiveHit&, const NaiveHit&) = default;
};

// Only hits `rim` inside a shape's outline, and `rim` in front of the ray's origin, count.
NaiveHit nearest_by_loop(const NaiveRay& ray, const Shapes& shapes, double rim = 0);
NaiveHit nearest_by_tree(const NaiveRay& ray, const Hierarchy& hierarchy, const Shapes& shapes);

// Rays of the kinds that break trees: along axes, in planes of corners, along edges, towards corners, from surfaces.
NaiveRay awkward_ray(Random& random, const ShapeSet& scene);

}  // namespace raywalk::testing
