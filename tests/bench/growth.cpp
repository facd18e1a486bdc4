#include "tests/bench/growth.h"

#include <omp.h>

#include "tests/bench/ray_rates.h"
#include "tests/bench/ray_sets.h"

namespace raywalk::bench {

namespace {

// Nanoseconds a ray, the middle one of three turns.
double nanoseconds(const RaySet& set, const CompiledScene& scene, const Kernels& kernels, HitBlocks& hits) {
    const auto door = traits_of(set.kind).common_origin ? kernels.intersect_beam : kernels.intersect;
    const Pass pass = timed(Clock::thread_cpu, [&] { door(scene, set.rays, hits); });
    return 1e9 * spread_of(take_turns({&pass, 1}, 3)[0]).median / static_cast<double>(set.live);
}

double milliseconds(Renderer& renderer, const View& view, Clock clock) {
    renderer.set_view(view);
    const Pass pass = timed(clock, [&] { render_again(renderer); });
    return 1e3 * spread_of(take_turns({&pass, 1}, 3)[0]).median;
}

}  // namespace

TriangleGrowth measure_triangles(std::size_t triangles, const Kernels& kernels) {
    const Geometry geometry = placed(bumpy_sphere(triangles), "bumpy sphere");
    const std::vector<TriangleCorners> corners = geometry.corners();
    TriangleGrowth growth;
    growth.triangles = static_cast<double>(corners.size());
    for (std::size_t a = 0; a < 2; ++a) {
        CompiledScene scene;
        scene.triangle_count = static_cast<std::int32_t>(corners.size());
        std::vector<double> cpu, wall;
        for (int round = 0; round < (triangles <= 300'000 ? 3 : 1); ++round) {
            BuildStatistics statistics;
            const double cpu_start = seconds(Clock::process_cpu), wall_start = seconds(Clock::wall);
            scene.hierarchy = accelerators[a] == Accelerator::kdtree
                                  ? build_kd_tree({corners, {}}, KdOptions{}, &statistics)
                                  : build_bvh({corners, {}}, &statistics);
            cpu.push_back(seconds(Clock::process_cpu) - cpu_start);
            wall.push_back(seconds(Clock::wall) - wall_start);
            growth.bytes[a] = static_cast<double>(statistics.bytes);
            growth.build_work[a] = static_cast<double>(statistics.events);
        }
        growth.build_seconds[a] = spread_of(cpu).median;
        growth.build_wall[a] = spread_of(wall).median;
        const RaySet primary = primary_rays({640, 360});
        HitBlocks hits(primary.rays.size());
        growth.primary[a] = nanoseconds(primary, scene, kernels, hits);
        const RaySet diffuse = secondary_rays(RayKind::diffuse_bounce, geometry, primary, hits);
        HitBlocks diffuse_hits(diffuse.rays.size());
        growth.diffuse[a] = nanoseconds(diffuse, scene, kernels, diffuse_hits);
    }
    return growth;
}

std::vector<FrameGrowth> measure_lights(const FrameScene& frame, const std::vector<int>& sides,
                                        const Kernels& kernels) {
    std::vector<FrameGrowth> growth;
    for (const int side : sides) {
        FrameScene lit = frame;
        lit.scene.lights.resize(1);
        if (side > 1) lit.scene.lights[0].area = AreaSpread{side, 0.5};
        const CompiledScene scene = compile_for(lit, Accelerator::bvh);
        View view = view_of(lit, 640, 360);
        Renderer renderer(scene, &kernels, 1);
        FrameGrowth at;
        at.count = static_cast<double>(side) * side;
        at.label = std::to_string(side * side);
        at.milliseconds = milliseconds(renderer, view, Clock::thread_cpu);
        view.settings.one_shot = false;
        at.sampled_milliseconds = milliseconds(renderer, view, Clock::thread_cpu);
        growth.push_back(at);
    }
    return growth;
}

std::vector<FrameGrowth> measure_sizes(const FrameScene& frame, const Kernels& kernels) {
    const CompiledScene scene = compile_for(frame, Accelerator::bvh);
    std::vector<FrameGrowth> growth;
    for (const int width : {160, 320, 640, 1280, 1920, 3840}) {
        const int height = width * 9 / 16;
        Renderer renderer(scene, &kernels, 1);
        FrameGrowth at;
        at.count = static_cast<double>(width) * height;
        at.label = std::to_string(width) + " x " + std::to_string(height);
        at.milliseconds = milliseconds(renderer, view_of(frame, width, height), Clock::thread_cpu);
        growth.push_back(at);
    }
    return growth;
}

std::vector<FrameGrowth> measure_threads(const FrameScene& frame, const Kernels& kernels) {
    const CompiledScene scene = compile_for(frame, Accelerator::bvh);
    std::vector<FrameGrowth> growth;
    for (int threads = 1; threads <= omp_get_max_threads(); ++threads) {
        Renderer renderer(scene, &kernels, threads);
        FrameGrowth at;
        at.count = threads;
        at.label = std::to_string(threads);
        at.milliseconds = milliseconds(renderer, view_of(frame, 1280, 720), Clock::wall);
        growth.push_back(at);
    }
    return growth;
}

}  // namespace raywalk::bench
