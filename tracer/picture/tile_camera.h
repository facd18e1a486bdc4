// The camera as one tile of a picture sees it, in floats from the scene's local origin.
#pragma once

#include <glm/vec3.hpp>

#include "tracer/picture/camera.h"

namespace raywalk {

// What is the same for all pixels of a tile: computed in double precision from the tile's corner, so that pixels of
// large pictures far from the middle are as sharp as the others.
struct TileCamera {
    int x, y, width, height;
    bool orthographic, common_origin;
    float corner[3];  // perspective: direction to the tile's corner; orthographic: that point of the image plane
    float right[3], down[3];  // one pixel
    float eye[3], direction[3];
    float aperture_right[3], aperture_up[3];  // aperture radius
    float focal_distance;
};

// The tile at pixel (x, y) of a width x height picture. `origin`: CompiledScene::origin.
TileCamera make_tile_camera(const Camera& camera, const glm::dvec3& origin, int width, int height, int x, int y);

}  // namespace raywalk
