// Every epsilon and NaN rule of the tracer, each with its reason. Machine epsilon e of a float is 2^-24 = 6e-8.
#pragma once

namespace raywalk {

// A spawned ray starts off its surface by this fraction of the largest coordinate (in magnitude) that made the hit,
// along the geometric normal: o + t d in floats is off by about 3 e of that, and the shapes' own data by e; the factor
// leaves room for grazing rays (Waechter and Binder, Ray Tracing Gems 6, offset by the same reasoning).
inline constexpr float surface_offset = 2e-6f;

// Shadow rays run from the light to the (offset) point over t in (0, 1); they stop short of it by this much.
inline constexpr float shadow_t_max = 1.0f - 4e-6f;

// Boxes are tested as if grown by this fraction of the largest coordinate of scene and ray origin: two roundings of
// b * rd - o * rd move a slab by at most 2 e of it each.
inline constexpr float box_padding = 3e-7f;

// Entry and exit distances of boxes are compared with this relative slack (Ize, Robust BVH Ray Traversal, 2013).
inline constexpr float slab_slack = 4e-7f;

// Single rays accept barycentric weights down to minus this, so that no ray slips between triangles that share an edge
// or a corner: the Moeller-Trumbore weights are off by about e |distance| / |edge|. A triangle grows by this fraction
// of its own size, which no picture shows.
inline constexpr float edge_slack = 1e-5f;

// A sum of three products is compared with zero with this slack, relative to the sum of their magnitudes.
inline constexpr float sum_slack = 3e-7f;

// A direction component smaller than this is replaced by it, sign kept, so that its reciprocal stays finite and
// 0 * infinity never appears.
inline constexpr float smallest_direction = 1e-18f;

}  // namespace raywalk
