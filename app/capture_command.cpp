#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>

#include "app/commands.h"
#include "app/display/frame_writer.h"
#include "app/display/no_display.h"
#include "app/display/presenter.h"
#include "app/exposure.h"
#include "app/process/console.h"
#include "app/process/interrupts.h"
#include "app/process/output_files.h"
#include "app/process/rescue.h"
#include "app/process/saving.h"
#include "app/process/statistics.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/stopwatch.h"
#include "tracer/ground/whole_file.h"
#include "tracer/kernels/kernels.h"
#include "tracer/rendering/resolve.h"

namespace raywalk {
namespace {

// "walk-%04d.png", 7 -> "walk-0007.png".
std::filesystem::path frame_name(const std::string& pattern, std::size_t number) {
    const std::size_t percent = pattern.find('%'), end = pattern.find('d', percent);
    const std::string digits = pattern.substr(percent + 1, end - percent - 1);
    char text[64];
    std::snprintf(text, sizeof text, "%0*zu", digits.empty() ? 1 : std::stoi(digits), number);
    return pattern.substr(0, percent) + text + pattern.substr(end + 1);
}

// A walk without a window: the same views, the same frames, drawn into memory.
class Capture {
  public:
    // `conclude` saves what there is when an interrupt comes in a step that takes long; it returns the exit code.
    Capture(const Options& options, const LoadedScene& loaded, std::function<int(Capture&)> conclude)
        : conclude_(std::move(conclude)),
          renderer_(loaded.compiled, select_kernels(options.isa), options.threads),
          samples_(samples_per_pixel(options, loaded.scene)) {
        // As in the window: exposure is that of the first full picture, whatever keys follow.
        const View opening = opening_view(options, loaded.scene);
        exposure_ = settled_exposure(options, loaded.scene, opening, renderer_);
        if (exposure_) return;
        trace(opening, 1);
        exposure_ = normalizing_exposure(renderer_.film());
    }

    // Everything of the view that there is time for before an interrupt.
    void trace(const View& view) { trace(view, samples_); }
    // Multiplies the exposure of the opening view.
    void expose(float factor) { exposure_factor_ = factor; }
    void save(const std::filesystem::path& file);

    [[nodiscard]] SavingReserve& reserve() { return reserve_; }
    [[nodiscard]] const Renderer& renderer() const { return renderer_; }
    [[nodiscard]] double traced_seconds() const { return traced_seconds_; }
    [[nodiscard]] const std::string& device_name() const { return presenter_.device_name(); }

  private:
    void trace(const View& view, std::uint32_t samples) {
        const Stopwatch watch;
        renderer_.set_view(view);
        {
            const Rescue rescue([&] {
                renderer_.close_film();
                traced_seconds_ += watch.seconds();
                return conclude_(*this);
            });
            renderer_.render_until(samples, interrupted());
        }
        traced_seconds_ += watch.seconds();
    }

    std::function<int(Capture&)> conclude_;
    SavingReserve reserve_;
    OffscreenPresenter presenter_;  // before the renderer: without a device there is no use in tracing
    Renderer renderer_;
    std::uint32_t samples_;
    std::optional<float> exposure_;  // none yet: of the picture itself
    float exposure_factor_ = 1;
    double traced_seconds_ = 0;
};

void Capture::save(const std::filesystem::path& file) {
    const UnbreakableSaving unbreakable(appears_whole(file));
    const Film& film = renderer_.film();
    if (is_float_extension(file)) {
        write_image(file, radiance_rows(film), saving_now());
        return;
    }
    const float exposure = (exposure_ ? *exposure_ : normalizing_exposure(film)) * exposure_factor_;
    publish_film(presenter_.exchange(), presenter_.preferred_content(), {.samples = renderer_.samples()}, film,
                 renderer_.kernels(), exposure, renderer_.threads());
    const std::vector<std::uint32_t> words = presenter_.present(film.width, film.height);
    write_image(file, film.width, film.height, rgb_bytes(words), saving_now());
}

// Saves what there is of the last picture; returns the exit code.
int conclude_capture(const Options& options, const LoadedScene& loaded, Capture& capture) {
    save_or_rescue(options.output, capture.renderer().film(), capture.reserve(), [&] { capture.save(options.output); });
    if (options.stats) {
        nlohmann::ordered_json statistics =
            statistics_of(options, loaded, capture.renderer(), capture.traced_seconds());
        statistics["device"] = capture.device_name();
        write_statistics(*options.stats, statistics);
    }
    if (interrupted()) {
        print_error("interrupted: " + quoted_name(options.output.string()) + " holds what there was of the picture");
        return exit_interrupted;
    }
    return exit_done;
}

int capture(const Options& options, const LoadedScene& loaded) {
    const bool quiet = options.verbosity == Verbosity::quiet;
    const GracefulInterrupts graceful;
    const Stopwatch watch;
    Capture capture(options, loaded, [&](Capture& self) { return conclude_capture(options, loaded, self); });
    if (options.verbosity == Verbosity::verbose) print_note("Vulkan device: " + capture.device_name());

    View view = opening_view(options, loaded.scene);
    std::size_t frames = 0;
    int presses = 0;  // of the exposure
    for (const WalkKey key : options.keys) {
        if (key == WalkKey::quit || interrupted()) break;
        view.camera = pressed(view.camera, key);
        presses += exposure_presses(key);
        capture.expose(exposure_factor(presses));
        if (!options.frames) continue;
        capture.trace(view);
        if (interrupted()) break;  // OUT holds what there is of this frame
        const std::filesystem::path frame = frame_name(*options.frames, frames++);
        require_no_input(frame, loaded.scene);
        capture.save(frame);
    }
    if (!interrupted()) capture.trace(view);
    if (const int exit_code = conclude_capture(options, loaded, capture); exit_code != exit_done) return exit_code;
    if (!quiet)
        print_note("captured " + printable(options.output.string()) +
                   (frames > 0 ? " and " + count_text(frames, "frame") : std::string()) + ", " +
                   count_text(samples_per_pixel(options, loaded.scene), "sample") + " a pixel, in " +
                   duration_text(watch.seconds()));
    return exit_done;
}

}  // namespace

int capture_command(const Options& options, LoadedScene&& loaded) {
    try {
        return capture(options, loaded);
    } catch (const NoDisplayError& error) {
        print_error(error.what());
        return exit_no_display;
    }
}

}  // namespace raywalk
