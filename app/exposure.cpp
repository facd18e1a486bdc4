#include "app/exposure.h"

#include <algorithm>
#include <cmath>

#include "app/process/interrupts.h"

namespace raywalk {

View at_own_size(const View& view, const Scene& scene) {
    constexpr double most_pixels = 1 << 20;
    const double pixels = static_cast<double>(scene.viewer.width) * scene.viewer.height;
    const double scale = std::min(1.0, std::sqrt(most_pixels / pixels));
    View own = view;
    own.width = std::max(1, static_cast<int>(scene.viewer.width * scale));
    own.height = std::max(1, static_cast<int>(scene.viewer.height * scale));
    own.camera = reshaped(view.camera, static_cast<double>(view.width) / view.height,
                          static_cast<double>(own.width) / own.height);
    return own;
}

std::optional<float> settled_exposure(const Options& options, const Scene& scene, const View& view,
                                      Renderer& renderer) {
    if (const auto fixed = options.exposure.value_or(Exposure{}).value) return fixed;
    if (view.width == scene.viewer.width && view.height == scene.viewer.height) return {};
    View own = at_own_size(view, scene);
    own.settings.one_shot = true;
    renderer.set_view(own);
    renderer.render_until(1, interrupted());
    return normalizing_exposure(renderer.film());
}

}  // namespace raywalk
