#include "tracer/kernels/kernels.h"

#include <algorithm>
#include <bit>

#include "tracer/kernels/tile_scratch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracer/kernels/kernels.cpp"
#include "hwy/foreach_target.h"

#include "tracer/ground/lanes.h"
#include "tracer/kernels/intersect.h"
#include "tracer/kernels/tile.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

bool left_out(const RayArrays& rays, std::size_t i) { return !(rays.t_max[i] > rays.t_min[i]); }

Ray ray_of(const RayArrays& rays, std::size_t i) {
    return {{rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]},
            {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]},
            rays.t_min[i],
            rays.t_max[i]};
}

// Copies numbers between arrays and the aligned arrays of a beam, in registers where there are 64 of them.
template <class T>
HWY_INLINE void copy(const T* from, T* to, std::size_t count) {
    if (count != beam_rays) {
        std::copy_n(from, count, to);
        return;
    }
    for (int at = 0; at < beam_rays; at += lanes) store_unaligned(load_unaligned(from + at), to + at);
}

// Rays [first, first + 64) of the arrays, as many as there are; returns which are not left out.
std::uint64_t fill_beam(const RayArrays& rays, std::size_t first, BeamRays& beam) {
    const std::size_t count = std::min<std::size_t>(rays.size() - first, beam_rays);
    for (int axis = 0; axis < 3; ++axis) copy(rays.direction[axis].data() + first, beam.direction[axis], count);
    copy(rays.t_min.data() + first, beam.t_min, count);
    copy(rays.t_max.data() + first, beam.t_max, count);
    for (int axis = 0; axis < 3; ++axis) beam.origin[axis] = rays.origin[axis][0];
    std::uint64_t active = 0;
    for (int at = 0; at < beam_rays; at += lanes)
        active |= static_cast<std::uint64_t>(bits(load(beam.t_max + at) > load(beam.t_min + at))) << at;
    return count == beam_rays ? active : active & ((std::uint64_t{1} << count) - 1);
}

void intersect_one_by_one(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayHit hit = left_out(rays, i) ? RayHit{rays.t_max[i], 0, 0, -1} : intersect_ray(scene, ray_of(rays, i));
        hits.t[i] = hit.t;
        hits.u[i] = hit.u;
        hits.v[i] = hit.v;
        hits.id[i] = hit.id;
    }
}

void intersect_as_beams(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    BeamRays beam = {};
    BeamHits found;
    for (std::size_t first = 0; first < rays.size(); first += beam_rays) {
        const std::size_t count = std::min<std::size_t>(rays.size() - first, beam_rays);
        const std::uint64_t active = fill_beam(rays, first, beam);
        if (active == 0) {
            std::fill_n(hits.id.begin() + static_cast<std::ptrdiff_t>(first), count, -1);
            continue;
        }
        intersect_beam(scene, beam, active, found);
        copy(found.t, hits.t.data() + first, count);
        copy(found.u, hits.u.data() + first, count);
        copy(found.v, hits.v.data() + first, count);
        copy(found.id, hits.id.data() + first, count);
    }
}

void occluded_one_by_one(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits.id[i] = !left_out(rays, i) && occluded_ray(scene, ray_of(rays, i)) ? 0 : -1;
}

void occluded_as_beams(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    BeamRays beam = {};
    for (std::size_t first = 0; first < rays.size(); first += beam_rays) {
        const std::uint64_t active = fill_beam(rays, first, beam);
        const std::uint64_t found = active == 0 ? 0 : occluded_beam(scene, beam, active);
        HWY_ALIGN std::int32_t ids[beam_rays];
        for (int at = 0; at < beam_rays; at += lanes)
            store(select(mask_of_bits(static_cast<std::uint32_t>(found >> at) & 0xffffu), Int(0), Int(-1)), ids + at);
        copy(ids, hits.id.data() + first, std::min<std::size_t>(rays.size() - first, beam_rays));
    }
}

}  // namespace

extern const Kernels kernels;
const Kernels kernels = {
#if HWY_TARGET == HWY_AVX3
    .name = "avx512",
#elif HWY_TARGET == HWY_AVX2
    .name = "avx2",
#elif HWY_TARGET == HWY_SSE4
    .name = "sse4",
#else
    .name = "scalar",
#endif
    .lanes = register_lanes,
    .trace_tile = trace_tile,
    .resolve_tile = resolve_tile,
    .intersect = intersect_one_by_one,
    .intersect_beam = intersect_as_beams,
    .occluded = occluded_one_by_one,
    .occluded_beam = occluded_as_beams,
};

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace raywalk {

RayArrays::RayArrays(std::size_t n) : t_min(n, 0), t_max(n, __builtin_inff()) {
    for (int axis = 0; axis < 3; ++axis) {
        origin[axis].resize(n);
        direction[axis].resize(n);
    }
}

HitArrays::HitArrays(std::size_t n) : t(n), u(n), v(n), id(n, -1) {}

TileScratchPointer make_tile_scratch() { return TileScratchPointer(new TileScratch()); }
void TileScratchDeleter::operator()(TileScratch* scratch) const { delete scratch; }

namespace {

std::vector<const Kernels*> runnable_kernels() {
    const std::int64_t targets = hwy::SupportedTargets();
    std::vector<const Kernels*> kernels;
    const auto add = [&](std::int64_t target, const Kernels& candidate) {
        if ((targets & target) != 0) kernels.push_back(&candidate);
    };
#if HWY_TARGETS & HWY_AVX3
    add(HWY_AVX3, N_AVX3::kernels);
#endif
#if HWY_TARGETS & HWY_AVX2
    add(HWY_AVX2, N_AVX2::kernels);
#endif
#if HWY_TARGETS & HWY_SSE4
    add(HWY_SSE4, N_SSE4::kernels);
#endif
    kernels.push_back(&N_SCALAR::kernels);
    (void)add;
    return kernels;
}

}  // namespace

std::span<const Kernels* const> available_kernels() {
    static const std::vector<const Kernels*> kernels = runnable_kernels();
    return kernels;
}

const Kernels* select_kernels(std::optional<std::string_view> name) {
    const auto kernels = available_kernels();
    if (!name) return kernels.front();
    const auto found = std::ranges::find(kernels, *name, &Kernels::name);
    return found == kernels.end() ? nullptr : *found;
}

}  // namespace raywalk

#endif  // HWY_ONCE
