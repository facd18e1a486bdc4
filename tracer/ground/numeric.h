// Every epsilon and NaN rule of the tracer, each with its reason. Machine epsilon e of a float is 2^-24 = 6e-8.
#pragma once

namespace raywalk {

// A spawned ray starts off its surface by this fraction of the largest coordinate (in magnitude) that made the hit,
// along the geometric normal: o + t d in floats is off by about 3 e of that, and the shapes' own data by e; the factor
// leaves room for grazing rays (Waechter and Binder, Ray Tracing Gems 6, offset by the same reasoning).
inline constexpr float surface_offset = 2e-6f;

// Where a hit is computed from numbers that are larger than itself, their rounding decides. A hit on a sphere is
// centre + radius * normal, off by 2 e of |centre| + radius, and a ray that leaves the sphere meets it again where
// rounding in the discriminant, 4 e of the radius, outweighs the distance between. The plane of a triangle is off by 3
// e of its farthest coordinate. Offsets are at least this fraction of those.
inline constexpr float sphere_offset = 8e-7f;
inline constexpr float triangle_offset = 4e-7f;

// Shadow rays run from the light to the (offset) point over t in (0, 1); they stop short of it by this much.
inline constexpr float shadow_t_max = 1.0f - 4e-6f;

// Boxes are tested as if grown by this fraction of the largest coordinate of scene and ray origin: two roundings of
// b * rd - o * rd move a slab by at most 2 e of it each, and triangles may grow (below) out of their boxes by the rest.
inline constexpr float box_padding = 8e-7f;

// Entry and exit distances of boxes are compared with this relative slack (Ize, Robust BVH Ray Traversal, 2013).
inline constexpr float slab_slack = 4e-7f;

// A triangle grows for each ray by this fraction of its distance from the ray's origin, so that no ray slips between
// triangles that share an edge or a corner: the weights u . d and v . d are off by some e |edge| |distance| |d|. That
// is less than coordinates are rounded by. Rays near its plane would see a triangle grow without end: by no more than
// the second, a fraction of its own size.
inline constexpr float triangle_growth = 2e-7f;
inline constexpr float most_growth = 0.02f;

// A direction component smaller than this is replaced by it, sign kept, so that its reciprocal stays finite and
// 0 * infinity never appears.
inline constexpr float smallest_direction = 1e-18f;

}  // namespace raywalk
