// Small scenes made in code, and pictures of them, for the tests of shading.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/kernels.h"
#include "tracer/picture/camera.h"

namespace raywalk {

struct Picture {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // mean radiance, rows from the top
    RayCounts counts;
    [[nodiscard]] glm::vec3 at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

struct PictureOptions {
    std::uint32_t samples = 1, seed = 0;
    bool one_shot = true;
    std::string_view kernels = {};  // the best where empty
    int threads = 1;
};

CompiledScene compiled(const Scene& scene, Accelerator accelerator = Accelerator::kdtree);
Picture picture_of(const CompiledScene& scene, const Camera& camera, int width, int height,
                   const PictureOptions& options = {});
// Compiled, seen by the scene's own viewer.
Picture picture_of(const Scene& scene, const PictureOptions& options = {});

// A viewer at the origin that looks along -z.
Viewer viewer_along_z(int width, int height, double fovy_degrees);
// A light of one point.
Light white_light(const glm::dvec3& origin, double intensity = 1);
// A surface of one colour, with coefficients of its own choice.
Texture surface(const glm::dvec3& color, const Material& material);
inline constexpr Material matte = {"matte", 0, 0, 0, 0, 0};
inline constexpr Material perfect_mirror = {"perfect mirror", 0, 0, 0, 1, 0};
inline constexpr Material see_through = {"clear", 0, 0, 0, 0, 1};

inline constexpr double mu = 0.02;  // attenuation per scene unit (spec 4)

// The unit direction through a point of the picture: (0, 0) the upper left corner, (width, height) the lower right.
glm::dvec3 direction_through(const Camera& camera, int width, int height, double x, double y);

// Share of pixels whose largest channel differs by more than `tolerance`.
double share_of_differing(const Picture& a, const Picture& b, double tolerance);

}  // namespace raywalk
