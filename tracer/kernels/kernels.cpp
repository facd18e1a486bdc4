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

// Copies numbers between arrays and the aligned arrays of a beam, in registers where there are 64 of them.
template <class T>
HWY_INLINE void copy(const T* from, T* to, std::size_t count) {
    if (count != beam_rays) {
        std::copy_n(from, count, to);
        return;
    }
    for (int at = 0; at < beam_rays; at += lanes) store_unaligned(load_unaligned(from + at), to + at);
}

// Which of the first `count` rays are not left out.
std::uint64_t taking_part(const float* t_min, const float* t_max, std::size_t count) {
    std::uint64_t active = 0;
    for (int at = 0; at < beam_rays; at += lanes)
        active |= static_cast<std::uint64_t>(bits(load(t_max + at) > load(t_min + at))) << at;
    return count == beam_rays ? active : active & ((std::uint64_t{1} << count) - 1);
}

// Rays [first, first + 64) of the arrays, as many as there are; returns which are not left out.
std::uint64_t fill_beam(const RayArrays& rays, std::size_t first, BeamRays& beam) {
    const std::size_t count = std::min<std::size_t>(rays.size() - first, beam_rays);
    for (int axis = 0; axis < 3; ++axis) copy(rays.direction[axis].data() + first, beam.direction[axis], count);
    copy(rays.t_min.data() + first, beam.t_min, count);
    copy(rays.t_max.data() + first, beam.t_max, count);
    for (int axis = 0; axis < 3; ++axis) beam.origin[axis] = rays.origin[axis][0];
    return taking_part(beam.t_min, beam.t_max, count);
}

std::uint64_t fill_scattered(const RayArrays& rays, std::size_t first, ScatteredRays& scattered) {
    const std::size_t count = std::min<std::size_t>(rays.size() - first, beam_rays);
    for (int axis = 0; axis < 3; ++axis) {
        copy(rays.origin[axis].data() + first, scattered.origin[axis], count);
        copy(rays.direction[axis].data() + first, scattered.direction[axis], count);
    }
    copy(rays.t_min.data() + first, scattered.t_min, count);
    copy(rays.t_max.data() + first, scattered.t_max, count);
    return taking_part(scattered.t_min, scattered.t_max, count);
}

// All rays of the arrays, 64 at a time: `fill` copies them into `some`, `trace` finds what the active ones hit.
template <class Rays, class Fill, class Trace>
void intersect_all(const RayArrays& rays, HitArrays& hits, Fill fill, Trace trace) {
    Rays some = {};
    BeamHits found;
    for (std::size_t first = 0; first < rays.size(); first += beam_rays) {
        const std::size_t count = std::min<std::size_t>(rays.size() - first, beam_rays);
        const std::uint64_t active = fill(rays, first, some);
        if (active == 0) {
            std::fill_n(hits.id.begin() + static_cast<std::ptrdiff_t>(first), count, -1);
            continue;
        }
        trace(some, active, found);
        copy(found.t, hits.t.data() + first, count);
        copy(found.u, hits.u.data() + first, count);
        copy(found.v, hits.v.data() + first, count);
        copy(found.id, hits.id.data() + first, count);
    }
}

template <class Rays, class Fill, class Trace>
void occlude_all(const RayArrays& rays, HitArrays& hits, Fill fill, Trace trace) {
    Rays some = {};
    for (std::size_t first = 0; first < rays.size(); first += beam_rays) {
        const std::uint64_t active = fill(rays, first, some);
        const std::uint64_t found = active == 0 ? 0 : trace(some, active);
        HWY_ALIGN std::int32_t ids[beam_rays];
        for (int at = 0; at < beam_rays; at += lanes)
            store(select(mask_of_bits(static_cast<std::uint32_t>(found >> at) & 0xffffu), Int(0), Int(-1)), ids + at);
        copy(ids, hits.id.data() + first, std::min<std::size_t>(rays.size() - first, beam_rays));
    }
}

void intersect_array(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    intersect_all<ScatteredRays>(rays, hits, fill_scattered, [&](const auto& some, std::uint64_t active, auto& found) {
        intersect_scattered(scene, some, active, found);
    });
}

void intersect_array_as_beams(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    intersect_all<BeamRays>(rays, hits, fill_beam, [&](const auto& some, std::uint64_t active, auto& found) {
        intersect_beam(scene, some, active, found);
    });
}

void occlude_array(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    occlude_all<ScatteredRays>(rays, hits, fill_scattered, [&](const auto& some, std::uint64_t active) {
        return occluded_scattered(scene, some, active);
    });
}

void occlude_array_as_beams(const CompiledScene& scene, const RayArrays& rays, HitArrays& hits) {
    occlude_all<BeamRays>(rays, hits, fill_beam, [&](const auto& some, std::uint64_t active) {
        return occluded_beam(scene, some, active, true);
    });
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
    .intersect = intersect_array,
    .intersect_beam = intersect_array_as_beams,
    .occluded = occlude_array,
    .occluded_beam = occlude_array_as_beams,
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
