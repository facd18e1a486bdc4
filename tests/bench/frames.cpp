#include "tests/bench/frames.h"
#include "tracer/compiled/compile.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/embree_scene.h"
#include "tests/bench/kernels_on_embree.h"
#include "tests/bench/whitted_on_embree.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk::bench {

namespace {

// Triangles and spheres as they went into the hierarchy.
Geometry geometry_of(const CompiledScene& scene) {
    Geometry geometry;
    geometry.positions.resize(static_cast<std::size_t>(scene.triangle_count) * 3);
    for (const TriangleBlock& block : scene.hierarchy.triangle_blocks) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            if (block.id[lane] < 0) continue;
            for (std::size_t i = 0; i < 3; ++i)
                geometry.positions[static_cast<std::size_t>(block.id[lane]) * 3 + i] = {
                    block.corner[i][0][lane], block.corner[i][1][lane], block.corner[i][2][lane]};
        }
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(scene.triangle_count); ++i)
        geometry.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    for (const SphereRecord& s : scene.spheres)
        geometry.spheres.push_back({{s.center[0], s.center[1], s.center[2]}, s.radius});
    return geometry;
}

double different_pixels(const FloatImage& a, const FloatImage& b) {
    float brightest = 1;
    for (const float value : b.rgb) brightest = std::max(brightest, value);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
        float most = 0;
        for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::fabs(a.rgb[i + c] - b.rgb[i + c]));
        if (!(most <= brightest / 255)) ++different;
    }
    return static_cast<double>(different) / (static_cast<double>(a.rgb.size()) / 3);
}

}  // namespace

FrameScene read_frame_scene(const std::filesystem::path& file) {
    std::vector<Diagnostic> warnings;
    return {file.stem().string(), read_scene(file, Limits{}, warnings)};
}

FrameScene mesh_scene(const std::filesystem::path& obj, std::string name, bool balls) {
    Scene scene;
    scene.file = obj;
    scene.viewer.width = 1280;
    scene.viewer.height = 720;
    scene.viewer.center = {-1, 4.5, 14};
    scene.viewer.target = {0, 2, 0};
    scene.lights.resize(2);
    scene.lights[0].origin = {-6, 12, 8};
    scene.lights[0].intensity = 0.8;
    scene.lights[1].origin = {5, 6, 14};
    scene.lights[1].intensity = 0.3;
    Plane floor;
    floor.texture.pattern = GridTexture{1};
    floor.offset = double{floor_height};
    scene.planes.push_back(floor);
    Mesh mesh;
    mesh.texture.material = materials[4];
    mesh.texture.pattern = PureTexture{{1, 1, 0}};
    mesh.file = obj;
    mesh.center = {0, mesh_height, 0};
    mesh.radius = mesh_radius;
    mesh.smooth = true;
    scene.meshes.push_back(mesh);
    if (balls) {
        name += " + 10,000 spheres";
        for (const SphereShape& ball : ball_field()) {
            Sphere sphere;
            sphere.texture.material = materials[4];
            sphere.texture.pattern = PureTexture{{0, 1, 1}};
            sphere.center = ball.center;
            sphere.radius = double{ball.radius};
            scene.spheres.push_back(sphere);
        }
    }
    return {std::move(name), std::move(scene)};
}

CompiledScene compile_for(const FrameScene& frame, Accelerator accelerator) {
    CompileOptions options;
    options.accelerator = accelerator;
    Limits limits;
    limits.allowed_folders.emplace_back("/");
    std::vector<Diagnostic> warnings;
    return compile(frame.scene, load_assets(frame.scene, limits, warnings), options);
}

View view_of(const FrameScene& frame, int width, int height) {
    View view;
    view.camera = opening_camera(frame.scene.viewer, static_cast<double>(width) / height);
    view.camera.aperture_radius = 0;
    view.width = width;
    view.height = height;
    return view;
}

void render_again(Renderer& renderer) {
    View view = renderer.view();
    view.settings.seed ^= 1;  // another view, so that the film is cleared; the first sample does not depend on it
    renderer.set_view(view);
    const std::atomic<bool> go_on{false};
    renderer.render_until(1, go_on);
}

FrameRow measure_frame(const FrameScene& frame, const FrameOptions& options) {
    const std::array<CompiledScene, 2> scenes = {compile_for(frame, Accelerator::kdtree),
                                                 compile_for(frame, Accelerator::bvh)};
    const EmbreeDevice device(omp_get_max_threads());
    const EmbreeScene embree(device, geometry_of(scenes[1]), {RTC_BUILD_QUALITY_HIGH, EmbreeSpheres::callback});
    SceneOnEmbree on_embree{scenes[1], embree.handle()};
    const View view = view_of(frame, options.width, options.height);

    std::array<Renderer, 2> ours = {Renderer(scenes[0], options.kernels, 1), Renderer(scenes[1], options.kernels, 1)};
    Renderer simd(on_embree, kernels_on_embree(options.kernels->name), 1);
    for (Renderer* renderer : {&ours[0], &ours[1], &simd}) renderer->set_view(view);
    FloatImage scalar_image;
    const Pass passes[] = {
        timed(Clock::thread_cpu, [&] { scalar_image = render_on_embree(scenes[1], embree.handle(), view); }),
        timed(Clock::thread_cpu, [&] { render_again(ours[0]); }),
        timed(Clock::thread_cpu,
              [&] {
                  const FlushDenormals flush;
                  render_again(simd);
              }),
        timed(Clock::thread_cpu, [&] { render_again(ours[1]); })};
    const auto times = take_turns(passes, options.rounds);

    FrameRow row;
    row.name = frame.name;
    row.scalar_on_embree = spread_of(times[0]).median;
    row.simd_on_embree = spread_of(times[2]).median;
    for (std::size_t a = 0; a < 2; ++a) {
        row.seconds[a] = spread_of(times[1 + 2 * a]).median;
        row.against_scalar[a] = ratio_of(times[0], times[1 + 2 * a]);
        row.against_simd[a] = ratio_of(times[2], times[1 + 2 * a]);
        row.different_pixels[a] = different_pixels(mean_radiance(ours[a].film()), scalar_image);
    }

    const std::size_t faster = row.seconds[0] < row.seconds[1] ? 0 : 1;
    Renderer two(scenes[faster], options.kernels, 2);
    two.set_view(view);
    const Pass by_threads[] = {timed(Clock::wall, [&] { render_again(ours[faster]); }),
                               timed(Clock::wall, [&] { render_again(two); })};
    const auto thread_times = take_turns(by_threads, options.rounds + 4);
    row.two_threads = ratio_of(thread_times[0], thread_times[1]);
    const Pass by_cpu_time[] = {timed(Clock::process_cpu, [&] { render_again(ours[faster]); }),
                                timed(Clock::process_cpu, [&] { render_again(two); })};
    auto cpu_times = take_turns(by_cpu_time, options.rounds + 4);
    for (double& time : cpu_times[1]) time /= 2;
    row.two_threads_cpu = ratio_of(cpu_times[0], cpu_times[1]);
    return row;
}

}  // namespace raywalk::bench
