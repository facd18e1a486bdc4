// The camera of a view, and the walk of a camera: plain values, pure functions.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "tracer/description/scene.h"

namespace raywalk {

enum class Projection { perspective, orthographic };

// `direction`, `right`, `up` are orthonormal. Double precision: a long walk must not drift.
struct Camera {
    Projection projection = Projection::perspective;
    glm::dvec3 eye{0}, direction{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};
    double half_height = 0.5;            // perspective: tan(fovy / 2), at distance 1
    glm::dvec2 orthographic_half{1, 1};  // half the viewport, scene units
    double aperture_radius = 0;          // 0: pinhole (perspective only)
    double focal_distance = 1;
    glm::dvec3 north{0, 1, 0};  // unit; the walk's fixed "up": the view never rolls about it
    friend bool operator==(const Camera&, const Camera&) = default;
};

// The camera with which the scene opens (spec 4.1, 4.2, and `T` in 2 for scenes without `view`).
// `aspect` = width / height of the picture.
Camera opening_camera(const Viewer& viewer, double aspect, std::optional<Projection> projection = {});

Camera toggled_projection(const Camera& camera);

}  // namespace raywalk
