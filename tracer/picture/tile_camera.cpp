#include "tracer/picture/tile_camera.h"

namespace raywalk {

TileCamera make_tile_camera(const Camera& camera, const glm::dvec3& origin, int width, int height, int x, int y) {
    const glm::dvec3 eye = camera.eye - origin;
    TileCamera c{};
    c.x = x;
    c.y = y;
    c.width = width;
    c.height = height;
    c.orthographic = camera.projection == Projection::orthographic;
    c.common_origin = !c.orthographic && camera.aperture_radius == 0;
    c.focal_distance = static_cast<float>(camera.focal_distance);
    const double half_height = c.orthographic ? camera.orthographic_half.y : camera.half_height;
    const double half_width = c.orthographic ? camera.orthographic_half.x : half_height * width / height;
    const double pixel_width = 2 * half_width / width, pixel_height = 2 * half_height / height;
    for (int axis = 0; axis < 3; ++axis) {
        const double corner = camera.direction[axis] + camera.right[axis] * (pixel_width * x - half_width) +
                              camera.up[axis] * (half_height - pixel_height * y);
        c.corner[axis] = static_cast<float>(c.orthographic ? eye[axis] + corner : corner);
        c.right[axis] = static_cast<float>(camera.right[axis] * pixel_width);
        c.down[axis] = static_cast<float>(camera.up[axis] * -pixel_height);
        c.eye[axis] = static_cast<float>(eye[axis]);
        c.direction[axis] = static_cast<float>(camera.direction[axis]);
        c.aperture_right[axis] = static_cast<float>(camera.right[axis] * camera.aperture_radius);
        c.aperture_up[axis] = static_cast<float>(camera.up[axis] * camera.aperture_radius);
    }
    return c;
}

}  // namespace raywalk
