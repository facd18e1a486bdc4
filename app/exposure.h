// The exposure of a picture whose size is not the scene's own: a preview is as bright as the final picture.
#pragma once

#include <optional>

#include "app/loaded_scene.h"
#include "tracer/picture/view.h"
#include "tracer/rendering/renderer.h"

namespace raywalk {

// The same view at the size that the scene's geo asks for; scaled down to a million pixels where it asks for more.
View at_own_size(const View& view, const Scene& scene);

// The factor of `--exposure`, or for `normalize` that of the view at the scene's own size, found by one sample a pixel
// with `renderer`, whose view is another afterwards. None where the view has that size: its own picture decides
// (spec 4.8).
std::optional<float> settled_exposure(const Options& options, const Scene& scene, const View& view, Renderer& renderer);

}  // namespace raywalk
