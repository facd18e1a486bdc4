#include "tests/kernels/scene.h"
#include "tracer/compiled/compile.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "tracer/rendering/renderer.h"

namespace raywalk {

CompiledScene compiled(const Scene& scene, Accelerator accelerator) {
    std::vector<Diagnostic> warnings;
    return compile(scene, load_assets(scene, {}, warnings), {.accelerator = accelerator, .kd = {}});
}

Picture picture_of(const CompiledScene& scene, const Camera& camera, int width, int height,
                   const PictureOptions& options) {
    const Kernels* kernels = options.kernels.empty() ? select_kernels() : select_kernels(options.kernels);
    if (kernels == nullptr) throw std::runtime_error("no kernels of this name");
    Renderer renderer(scene, kernels, options.threads);
    renderer.set_view({.camera = camera,
                       .width = width,
                       .height = height,
                       .settings = {.seed = options.seed, .one_shot = options.one_shot}});
    const std::atomic<bool> cancel = false;
    renderer.render_until(options.samples, cancel);
    const FloatImage image = mean_radiance(renderer.film());
    Picture picture{.width = width, .height = height, .pixels = {}, .counts = renderer.ray_counts()};
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        picture.pixels.emplace_back(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
    return picture;
}

Picture picture_of(const Scene& scene, const PictureOptions& options) {
    const double aspect = static_cast<double>(scene.viewer.width) / scene.viewer.height;
    return picture_of(compiled(scene), opening_camera(scene.viewer, aspect), scene.viewer.width, scene.viewer.height,
                      options);
}

Viewer viewer_along_z(int width, int height, double fovy_degrees) {
    Viewer viewer;
    viewer.width = width;
    viewer.height = height;
    viewer.center = {0, 0, 0};
    viewer.target = {0, 0, -1};
    viewer.up = {0, 1, 0};
    viewer.fovy_degrees = fovy_degrees;
    return viewer;
}

Light white_light(const glm::dvec3& origin, double intensity) {
    return {.origin = origin, .color = glm::dvec3(1), .intensity = intensity, .area = {}};
}

Texture surface(const glm::dvec3& color, const Material& material) {
    return {.material = material, .pattern = PureTexture{color}};
}

glm::dvec3 direction_through(const Camera& camera, int width, int height, double x, double y) {
    const double half_width = camera.half_height * width / height;
    return glm::normalize(camera.direction + camera.right * (half_width * (2 * x / width - 1)) +
                          camera.up * (camera.half_height * (1 - 2 * y / height)));
}

double share_of_differing(const Picture& a, const Picture& b, double tolerance) {
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::vec3 d = glm::abs(a.pixels[i] - b.pixels[i]);
        differing += !(std::max({d.x, d.y, d.z}) <= tolerance);
    }
    return static_cast<double>(differing) / static_cast<double>(a.pixels.size());
}

}  // namespace raywalk
