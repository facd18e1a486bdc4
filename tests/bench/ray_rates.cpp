#include "tests/bench/ray_rates.h"

#include <omp.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "tests/bench/embree_scene.h"

namespace raywalk::bench {

namespace {

// An Embree scene and a way to ask it.
struct EmbreeContender {
    const EmbreeScene* scene;
    EmbreeCall call;
    [[nodiscard]] std::string name(bool any_hit, bool has_spheres) const {
        return to_string(call, any_hit) + ", " + to_string(scene->build(), has_spheres);
    }
};

std::vector<std::unique_ptr<EmbreeScene>> embree_scenes(const EmbreeDevice& device, const Geometry& geometry) {
    std::vector<std::unique_ptr<EmbreeScene>> scenes;
    for (const RTCBuildQuality quality : {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH}) {
        for (const EmbreeSpheres spheres : {EmbreeSpheres::callback, EmbreeSpheres::point}) {
            if (geometry.spheres.empty() && spheres == EmbreeSpheres::point) continue;
            scenes.push_back(std::make_unique<EmbreeScene>(device, geometry, EmbreeBuild{quality, spheres}));
        }
    }
    return scenes;
}

void trace(const EmbreeContender& contender, std::int32_t triangle_count, const RaySet& set, HitBlocks& hits) {
    EmbreeCall call = contender.call;
    call.common_origin = traits_of(set.kind).common_origin;
    if (traits_of(set.kind).any_hit)
        occluded(contender.scene->handle(), call, set.rays, hits);
    else
        intersect(contender.scene->handle(), triangle_count, call, set.rays, hits);
}

void trace(const Kernels& kernels, const CompiledScene& scene, const RaySet& set, HitBlocks& hits) {
    const KindTraits& traits = traits_of(set.kind);
    const auto door = traits.any_hit ? (traits.common_origin ? kernels.occluded_beam : kernels.occluded)
                                     : (traits.common_origin ? kernels.intersect_beam : kernels.intersect);
    door(scene, set.rays, hits);
}

// The two contenders that a short comparison finds fastest, fastest first; notes what it measured.
std::vector<EmbreeContender> fastest_two(const std::vector<EmbreeContender>& contenders, std::int32_t triangle_count,
                                         const RaySet& set, RateRow& row, bool has_spheres) {
    const RaySet sample = thinned(set, 5);
    HitBlocks hits(sample.rays.size());
    std::vector<Pass> passes;
    passes.reserve(contenders.size());
    for (const EmbreeContender& c : contenders)
        passes.push_back(timed(Clock::thread_cpu, [&] { trace(c, triangle_count, sample, hits); }));
    const auto times = take_turns(passes, 3);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const double time = spread_of(times[i]).median;
        order.emplace_back(time, i);
        row.calls[contenders[i].name(traits_of(set.kind).any_hit, has_spheres)] =
            static_cast<double>(sample.live) / time;
    }
    std::sort(order.begin(), order.end());
    return {contenders[order[0].second], contenders[order[1].second]};
}

RateRow measure_kind(const Geometry& geometry, const std::vector<EmbreeContender>& contenders,
                     const std::array<CompiledScene, 2>& scenes, const RaySet& set, const RateOptions& options) {
    const KindTraits& traits = traits_of(set.kind);
    const bool has_spheres = !geometry.spheres.empty();
    const auto triangle_count = static_cast<std::int32_t>(geometry.faces.size());
    RateRow row;
    row.workload = geometry.name, row.kind = set.kind, row.rays = set.live;
    const std::vector<EmbreeContender> best = fastest_two(contenders, triangle_count, set, row, has_spheres);

    std::array<HitBlocks, 4> hits;
    hits.fill(HitBlocks(set.rays.size()));
    const auto ours = [&](std::size_t a) {
        return timed(Clock::thread_cpu, [&, a] { trace(*options.kernels, scenes[a], set, hits[1 + 2 * a]); });
    };
    const auto theirs = [&](std::size_t b) {
        return timed(Clock::thread_cpu, [&, b] { trace(best[b], triangle_count, set, hits[2 * b]); });
    };
    const Pass passes[] = {theirs(0), ours(0), theirs(1), ours(1)};
    const auto times = take_turns(passes, options.rounds);

    const auto rate = [&](std::size_t pass) { return static_cast<double>(set.live) / spread_of(times[pass]).median; };
    const std::size_t embree = rate(0) >= rate(2) ? 0 : 2;
    row.best_embree = best[embree / 2].name(traits.any_hit, has_spheres);
    row.embree_rate = rate(embree);
    for (std::size_t a = 0; a < 2; ++a) {
        row.rate[a] = rate(1 + 2 * a);
        row.ratio[a] = ratio_of(times[embree], times[1 + 2 * a]);
        row.agreement[a] = compare(geometry, set, hits[embree], hits[1 + 2 * a]);
    }
    return row;
}

}  // namespace

std::string_view name_of(Accelerator accelerator) { return accelerator == Accelerator::kdtree ? "kd-tree" : "BVH"; }

CompiledScene compiled_shapes(const Geometry& geometry, Accelerator accelerator, BuildStatistics* statistics) {
    const std::vector<TriangleCorners> corners = geometry.corners();
    const Shapes shapes{corners, geometry.spheres};
    CompiledScene scene;
    scene.triangle_count = static_cast<std::int32_t>(corners.size());
    scene.sphere_count = static_cast<std::int32_t>(geometry.spheres.size());
    scene.hierarchy = accelerator == Accelerator::kdtree ? build_kd_tree(shapes, KdOptions{}, statistics)
                                                         : build_bvh(shapes, statistics);
    return scene;
}

double trace_for(double duration, RayKind kind, Accelerator accelerator, const Geometry& geometry,
                 const RateOptions& options) {
    const CompiledScene scene = compiled_shapes(geometry, accelerator);
    RaySet set = primary_rays(options.picture);
    HitBlocks hits(set.rays.size());
    trace(*options.kernels, scene, set, hits);
    if (kind != RayKind::primary) set = secondary_rays(kind, geometry, set, hits);
    const double start = seconds(Clock::thread_cpu);
    double spent = 0;
    std::size_t rays = 0;
    for (; spent < duration; spent = seconds(Clock::thread_cpu) - start, rays += set.live)
        trace(*options.kernels, scene, set, hits);
    return static_cast<double>(rays) / spent;
}

std::vector<RateRow> measure_rates(const Geometry& geometry, const RateOptions& options) {
    const EmbreeDevice device(omp_get_max_threads());
    const auto embree = embree_scenes(device, geometry);
    std::vector<EmbreeContender> contenders;
    for (const auto& scene : embree)
        for (const EmbreeCall& call : embree_calls()) contenders.push_back({scene.get(), call});
    const std::array<CompiledScene, 2> scenes = {compiled_shapes(geometry, Accelerator::kdtree),
                                                 compiled_shapes(geometry, Accelerator::bvh)};

    const RaySet primary = primary_rays(options.picture);
    HitBlocks primary_hits(primary.rays.size());
    intersect(embree[0]->handle(), scenes[0].triangle_count, {16, true}, primary.rays, primary_hits);
    std::vector<RateRow> rows;
    for (const RayKind kind : ray_kinds) {
        const RaySet set = kind == RayKind::primary ? primary : secondary_rays(kind, geometry, primary, primary_hits);
        rows.push_back(measure_kind(geometry, contenders, scenes, set, options));
    }
    return rows;
}

}  // namespace raywalk::bench
