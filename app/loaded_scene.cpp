#include "app/loaded_scene.h"

#include "app/process/console.h"
#include "app/process/output_files.h"
#include "tracer/compiled/compile.h"
#include "tracer/compiled/local_origin.h"
#include "tracer/files/load.h"
#include "tracer/files/scene_text/parser.h"
#include "tracer/ground/stopwatch.h"

namespace raywalk {

LoadedScene load_scene(const Options& options) {
    LoadedScene loaded;
    std::vector<Diagnostic> warnings;
    const auto print_warnings = [&] {
        if (options.verbosity != Verbosity::quiet) print_diagnostics(warnings);
    };
    try {
        const Stopwatch watch;
        loaded.scene = read_scene(options.scene, options.limits, warnings);
        loaded.read_seconds = watch.seconds();
        require_inputs_kept(options, loaded.scene);
        for (Diagnostic& warning : small_shape_warnings(loaded.scene)) warnings.push_back(std::move(warning));
        Assets assets = load_assets(loaded.scene, options.limits, warnings);
        loaded.mesh_seconds = assets.mesh_seconds;
        loaded.image_seconds = assets.image_seconds;
        loaded.compiled = compile(loaded.scene, std::move(assets), options.compile, &loaded.build);
        loaded.load_seconds = watch.seconds();
    } catch (const InputError&) {
        print_warnings();
        throw;
    }
    print_warnings();
    return loaded;
}

glm::ivec2 picture_size(const Options& options, const Scene& scene) {
    return options.size.value_or(glm::ivec2(scene.viewer.width, scene.viewer.height));
}

std::uint32_t samples_per_pixel(const Options& options, const Scene& scene) {
    if (options.samples_per_pixel) return *options.samples_per_pixel;
    const int aperture = scene.viewer.depth_of_field ? scene.viewer.depth_of_field->samples : 1;
    return static_cast<std::uint32_t>(aperture) * static_cast<std::uint32_t>(scene.viewer.antialiasing.value_or(1));
}

View opening_view(const Options& options, const Scene& scene) {
    const glm::ivec2 size = picture_size(options, scene);
    return {.camera = opening_camera(scene.viewer, static_cast<double>(size.x) / size.y, options.projection),
            .width = size.x,
            .height = size.y,
            .settings = {.seed = options.seed, .one_shot = samples_per_pixel(options, scene) == 1}};
}

}  // namespace raywalk
