#include "tracer/picture/camera.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace raywalk {

Camera opening_camera(const Viewer& viewer, double aspect, std::optional<Projection> projection) {
    Camera camera;
    camera.eye = viewer.center;
    camera.north = glm::normalize(viewer.up);
    camera.direction = glm::normalize(viewer.target - viewer.center);
    camera.right = glm::normalize(glm::cross(camera.direction, camera.north));
    camera.up = glm::cross(camera.right, camera.direction);
    camera.half_height = std::tan(viewer.fovy_degrees / 360 * std::numbers::pi);

    if (viewer.viewport) {
        const double own_aspect = static_cast<double>(viewer.width) / viewer.height;
        camera.orthographic_half = *viewer.viewport / 2.0;
        camera = reshaped(camera, own_aspect, aspect);
    } else {
        const double half = camera.half_height * glm::length(viewer.target - viewer.center);
        camera.orthographic_half = {half * aspect, half};
    }
    camera.projection = projection.value_or(viewer.viewport ? Projection::orthographic : Projection::perspective);

    if (viewer.depth_of_field) {
        camera.aperture_radius = viewer.depth_of_field->aperture_radius;
        camera.focal_distance = viewer.depth_of_field->focal_distance;
    }
    return camera;
}

Camera toggled_projection(const Camera& camera) {
    Camera toggled = camera;
    toggled.projection =
        camera.projection == Projection::perspective ? Projection::orthographic : Projection::perspective;
    return toggled;
}

Camera reshaped(const Camera& camera, double old_aspect, double new_aspect) {
    Camera other = camera;
    other.orthographic_half.x *= new_aspect / old_aspect;
    return other;
}

}  // namespace raywalk
