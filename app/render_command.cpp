#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>

#include "app/commands.h"
#include "app/exposure.h"
#include "app/process/console.h"
#include "app/process/interrupts.h"
#include "app/process/output_files.h"
#include "app/process/progress.h"
#include "app/process/rescue.h"
#include "app/process/saving.h"
#include "app/process/statistics.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/stopwatch.h"
#include "tracer/ground/whole_file.h"
#include "tracer/kernels/kernels.h"
#include "tracer/rendering/renderer.h"
#include "tracer/rendering/resolve.h"

namespace raywalk {

namespace {

// Samples of one pass over the picture. An interrupted picture of many samples is then a noisier one, not half of one.
constexpr std::uint32_t samples_per_pass = 16;

// Every sample of the picture, with progress; returns early when interrupted, and where one step takes long then, ends
// the program with what `conclude` does and returns.
void render(Renderer& renderer, std::uint32_t samples, bool quiet, const std::function<int()>& conclude) {
    const auto tiles = static_cast<std::uint64_t>(renderer.film().tiles.size());
    const std::uint64_t passes = (samples + samples_per_pass - 1) / samples_per_pass;
    Progress progress(Progress::style_for(quiet), tiles * passes);
    const Rescue rescue([&] {
        progress.finish();
        renderer.close_film();
        return conclude();
    });
    for (std::uint32_t done = 0; done < samples && !interrupted();) {
        done = samples - done <= samples_per_pass ? samples : done + samples_per_pass;
        renderer.render_until(done, interrupted(), [&](int) { progress.advance(); });
    }
}

// `exposure`: none where that of the picture itself counts. Keys of the script multiply either.
void save(const Renderer& renderer, const Options& options, std::optional<float> exposure) {
    const UnbreakableSaving unbreakable(appears_whole(options.output));
    const Film& film = renderer.film();
    if (is_float_extension(options.output)) {
        write_image(options.output, radiance_rows(film), saving_now());
        return;
    }
    const float keys = exposure_factor(exposure_presses(options.keys));
    const float factor = (exposure ? *exposure : normalizing_exposure(film)) * keys;
    write_image(options.output, film.width, film.height, display_values(film, renderer.kernels(), factor),
                saving_now());
}

// Of all the samples asked for, how many are there: 0..1.
double finished_share(const Film& film, std::uint32_t samples) {
    std::uint64_t done = 0;
    for (const std::uint32_t of_tile : film.samples) done += of_tile;
    return static_cast<double>(done) / (static_cast<double>(samples) * static_cast<double>(film.samples.size()));
}

std::string size_text(const Film& film) { return std::to_string(film.width) + " x " + std::to_string(film.height); }

void print_load_times(const LoadedScene& loaded) {
    print_note("scene read in " + duration_text(loaded.read_seconds) + ", meshes in " +
               duration_text(loaded.mesh_seconds) + ", images in " + duration_text(loaded.image_seconds) +
               "; tree built in " + duration_text(loaded.build.seconds));
}

void print_ray_times(const Renderer& renderer, double seconds) {
    const RayCounts& rays = renderer.ray_counts();
    const std::uint64_t all = rays.camera + rays.shadow + rays.reflection + rays.refraction;
    print_note(count_text(all, "ray") + ", " +
               count_text(static_cast<std::uint64_t>(static_cast<double>(all) / std::max(seconds, 1e-9)), "ray") +
               " a second, " + count_text(static_cast<std::uint64_t>(renderer.threads()), "thread") + ", " +
               std::string(renderer.kernels().name));
}

// Saves what there is of the picture and says so; returns the exit code.
int conclude_picture(const Options& options, const LoadedScene& loaded, const Renderer& renderer, std::uint32_t samples,
                     std::optional<float> exposure, SavingReserve& reserve, double seconds) {
    const bool quiet = options.verbosity == Verbosity::quiet, verbose = options.verbosity == Verbosity::verbose;
    save_or_rescue(options.output, renderer.film(), reserve, [&] { save(renderer, options, exposure); });
    if (options.stats) write_statistics(*options.stats, statistics_of(options, loaded, renderer, seconds));
    if (const std::uint64_t dropped = renderer.ray_counts().dropped_samples; dropped > 0 && !quiet)
        print_warning(count_text(dropped, "sample") + " were not finite and count as black");

    const double share = finished_share(renderer.film(), samples);
    if (share < 1) {
        char percent[32];
        std::snprintf(percent, sizeof percent, "%.1f %%", 100 * share);
        print_error("interrupted after " + duration_text(seconds) + ": " + quoted_name(options.output.string()) +
                    " holds " + percent + " of the picture's samples");
        return exit_interrupted;
    }
    if (verbose) print_ray_times(renderer, seconds);
    if (!quiet)
        print_note("rendered " + printable(options.output.string()) + ", " + size_text(renderer.film()) + " pixels, " +
                   count_text(samples, "sample") + " each, in " + duration_text(seconds));
    return exit_done;
}

}  // namespace

int render_command(const Options& options, const LoadedScene& loaded) {
    const bool quiet = options.verbosity == Verbosity::quiet, verbose = options.verbosity == Verbosity::verbose;
    if (options.exposure && is_float_extension(options.output) && !quiet)
        print_warning("--exposure changes nothing here: " + options.output.extension().string() +
                      " files hold linear radiance");
    if (verbose) print_load_times(loaded);

    const GracefulInterrupts graceful;
    const Stopwatch watch;
    SavingReserve reserve;
    Renderer renderer(loaded.compiled, select_kernels(options.isa), options.threads);
    View view = opening_view(options, loaded.scene);
    view.camera = pressed(view.camera, options.keys);
    std::optional<float> exposure;
    if (!is_float_extension(options.output)) exposure = settled_exposure(options, loaded.scene, view, renderer);
    renderer.set_view(view);
    const std::uint32_t samples = samples_per_pixel(options, loaded.scene);
    const auto conclude = [&] {
        return conclude_picture(options, loaded, renderer, samples, exposure, reserve, watch.seconds());
    };
    render(renderer, samples, quiet, conclude);
    return conclude();
}

}  // namespace raywalk
