// The rays of one picture of 1280 x 720, sorted into the kinds that a renderer asks for.
#pragma once

#include <string_view>
#include <vector>

#include "tests/bench/geometry.h"
#include "tracer/kernels/kernels.h"

namespace raywalk::bench {

enum class RayKind { primary, shadow, planar_mirror, curved_reflection, diffuse_bounce };
inline constexpr RayKind ray_kinds[] = {RayKind::primary, RayKind::shadow, RayKind::planar_mirror,
                                        RayKind::curved_reflection, RayKind::diffuse_bounce};

// How many times faster than Embree rays of a kind are to be (the goal), and where we want to be.
struct KindTraits {
    std::string_view name;
    bool any_hit;        // asks whether, not where
    bool common_origin;  // goes as beams
    double goal, stretch;
};
const KindTraits& traits_of(RayKind kind);

// In tile order: 64 rays for each 8x8 pixels, in the order of film.h. Rays that do not exist (a camera ray that hits
// nothing has no shadow ray) have t_max = 0 and are left out by everyone.
struct RaySet {
    RayKind kind;
    RayBlocks rays;
    std::size_t live = 0;  // that exist
};

struct Picture {
    int width = 1280, height = 720;  // multiples of 8
};

RaySet primary_rays(const Picture& picture);
// Of `kind`, which is not primary, from the nearest hits of the primary rays; without blocks of 64 of which none
// exists.
RaySet secondary_rays(RayKind kind, const Geometry& geometry, const RaySet& primary, const HitBlocks& hits);
// Every `step`-th block of 64 rays.
RaySet thinned(const RaySet& set, std::size_t step);

}  // namespace raywalk::bench
