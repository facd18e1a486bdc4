#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/commands.h"
#include "app/display/no_display.h"
#include "app/exposure.h"
#include "app/process/console.h"
#include "app/process/interrupts.h"
#include "app/process/statistics.h"
#include "app/walk/walk_loop.h"
#include "tracer/kernels/kernels.h"
#include "tracer/picture/camera.h"

namespace raywalk {
namespace {

// A pixel, or fewer where the picture stands still before: no eye sees another one, and laptops stay cool.
constexpr std::uint32_t default_sample_limit = 256;

// Milliseconds below which so many of a hundred lie.
nlohmann::ordered_json percentiles(std::vector<double> seconds) {
    nlohmann::ordered_json result = {{"count", seconds.size()}};
    if (seconds.empty()) return result;
    std::ranges::sort(seconds);
    const auto at = [&](double share) {
        return 1000 * seconds[static_cast<std::size_t>(std::lround(share * static_cast<double>(seconds.size() - 1)))];
    };
    result["p50_ms"] = at(0.5);
    result["p90_ms"] = at(0.9);
    result["p99_ms"] = at(0.99);
    result["max_ms"] = seconds.back() * 1000;
    return result;
}

// The properties of a scene's Viewer that open it where the walk ended.
nlohmann::ordered_json viewer_of(const Camera& camera) {
    const auto text = [](const glm::dvec3& v) {
        char line[96];
        std::snprintf(line, sizeof line, "%.17g %.17g %.17g", v.x, v.y, v.z);
        return std::string(line);
    };
    return {{"center", text(camera.eye)}, {"target", text(camera.eye + camera.direction)}, {"up", text(camera.north)}};
}

nlohmann::ordered_json walk_statistics(const Options& options, const LoadedScene& loaded, const Renderer& renderer,
                                       const RenderThread& render, const WalkRecord& record,
                                       const std::string& device) {
    nlohmann::ordered_json statistics = statistics_of(options, loaded, renderer, render.traced_seconds());
    statistics["frames"] = {{"moving", percentiles(render.moving_frame_seconds())},
                            {"interval", percentiles(record.frame_intervals)},
                            {"answer", percentiles(record.answer_seconds)},
                            {"present", percentiles(record.present_seconds)}};
    statistics["viewer"] = viewer_of(record.camera);
    statistics["device"] = device;
    return statistics;
}

int walk_in_window(const Options& options, const LoadedScene& loaded) {
    const GracefulInterrupts graceful;
    const std::string name = printable(options.scene.filename().string());
    Window window(picture_size(options, loaded.scene), "Raywalk - " + name);
    Presenter presenter(window.handle());
    if (options.verbosity == Verbosity::verbose) print_note("Vulkan device: " + presenter.device_name());
    if (options.verbosity != Verbosity::quiet)
        print_note("W S A D walk, arrows turn, T changes the projection, [ ] the exposure, Q, Ctrl+Q or Escape quits");

    const std::uint32_t limit = options.samples_per_pixel.value_or(default_sample_limit);
    Options of_window = options;  // a window that the screen has no room for is smaller than the picture
    of_window.size = window.pixels();
    View opening = opening_view(of_window, loaded.scene);
    opening.settings.one_shot = limit == 1;
    View view = opening;
    view.camera = pressed(view.camera, options.keys);
    const int scripted_presses = exposure_presses(options.keys);

    Renderer renderer(loaded.compiled, select_kernels(options.isa), options.threads);
    RenderThread render(renderer, presenter.exchange(),
                        {.opening = at_own_size(opening, loaded.scene),
                         .exposure = options.exposure.value_or(Exposure{}).value,
                         .exposure_factor = exposure_factor(scripted_presses),
                         .sample_limit = limit,
                         .until_still = !options.samples_per_pixel,
                         .content = presenter.preferred_content(),
                         .frame_ready = Window::wake},
                        view);
    const WalkRecord record = walk_loop(window, presenter, render,
                                        {.name = name,
                                         .view = view,
                                         .exposure_presses = scripted_presses,
                                         .sample_limit = limit,
                                         .quit_at_once = std::ranges::count(options.keys, WalkKey::quit) > 0});
    render.stop();
    if (options.stats)
        write_statistics(*options.stats,
                         walk_statistics(options, loaded, renderer, render, record, presenter.device_name()));
    return record.interrupted ? exit_interrupted : exit_done;
}

}  // namespace

int walk_command(const Options& options, LoadedScene&& loaded) {
    try {
        return walk_in_window(options, loaded);
    } catch (const NoDisplayError& error) {
        print_error(error.what());
        return exit_no_display;
    }
}

}  // namespace raywalk
