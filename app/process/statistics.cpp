#include "app/process/statistics.h"

#include "app/process/console.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {

namespace {

using json = nlohmann::ordered_json;

json counts_of(const LoadedScene& loaded) {
    const CompiledScene& scene = loaded.compiled;
    return {{"file", loaded.scene.file.string()},  {"meshes", loaded.scene.meshes.size()},
            {"triangles", scene.triangle_count},   {"smooth_triangles", scene.smooth_count},
            {"spheres", scene.sphere_count},       {"planes", scene.plane_count},
            {"lights", scene.light_groups.size()}, {"light_points", scene.light_points.size()},
            {"surfaces", scene.surfaces.size()},   {"image_pixels", scene.texels.size()}};
}

json tree_of(const Options& options, const BuildStatistics& build) {
    return {{"accelerator", options.compile.accelerator == Accelerator::kdtree ? "kdtree" : "bvh"},
            {"inner_nodes", build.inner_nodes},
            {"leaves", build.leaves},
            {"empty_leaves", build.empty_leaves},
            {"references", build.references},
            {"depth", build.depth},
            {"sah_cost", build.sah_cost},
            {"events", build.events},
            {"bytes", build.bytes}};
}

json rays_of(const RayCounts& rays, double trace_seconds) {
    const std::uint64_t all = rays.camera + rays.shadow + rays.reflection + rays.refraction;
    return {{"camera", rays.camera},
            {"shadow", rays.shadow},
            {"reflection", rays.reflection},
            {"refraction", rays.refraction},
            {"all", all},
            {"per_second", trace_seconds > 0 ? static_cast<double>(all) / trace_seconds : 0.0},
            {"dropped_samples", rays.dropped_samples}};
}

}  // namespace

json statistics_of(const Options& options, const LoadedScene& loaded, const Renderer& renderer, double trace_seconds) {
    const View& view = renderer.view();
    return {{"version", RAYWALK_VERSION},
            {"scene", counts_of(loaded)},
            {"picture",
             {{"width", view.width},
              {"height", view.height},
              {"samples_per_pixel", renderer.samples()},
              {"projection", view.camera.projection == Projection::perspective ? "perspective" : "orthographic"},
              {"seed", view.settings.seed}}},
            {"seconds",
             {{"read_scene", loaded.read_seconds},
              {"read_meshes", loaded.mesh_seconds},
              {"read_images", loaded.image_seconds},
              {"build", loaded.build.seconds},
              {"load", loaded.load_seconds},
              {"trace", trace_seconds}}},
            {"rays", rays_of(renderer.ray_counts(), trace_seconds)},
            {"tree", tree_of(options, loaded.build)},
            {"threads", renderer.threads()},
            {"isa", renderer.kernels().name},
            {"lanes", renderer.kernels().lanes}};
}

void write_statistics(const std::filesystem::path& file, const json& statistics) {
    // Names of files need not be UTF-8, JSON must be; in ASCII none of them steers a terminal.
    const std::string text = statistics.dump(2, ' ', true, json::error_handler_t::replace) + "\n";
    if (file == "-")
        print_result(text);
    else
        write_whole(file, text);
}

}  // namespace raywalk
