// The camera of a view, and the walk of a camera: plain values, pure functions.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "tracer/scene/scene.h"

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

// The camera with which the scene opens: orthographic where it has `view` or `projection` says so. Without `view` the
// orthographic viewport keeps the picture's size at the distance of the target. `aspect` = width / height of the
// picture; where it is not that of the scene's `geo`, a viewport keeps its height and changes its width.
Camera opening_camera(const Viewer& viewer, double aspect, std::optional<Projection> projection = {});

// Perspective becomes orthographic and back; nothing else changes.
Camera toggled_projection(const Camera& camera);

// The same camera for a picture of another shape: the height of what is seen stays, the width follows.
// Aspects are width / height.
Camera reshaped(const Camera& camera, double old_aspect, double new_aspect);

}  // namespace raywalk
