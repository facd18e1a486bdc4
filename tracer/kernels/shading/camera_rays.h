// Camera rays of one tile (spec 4.1, 4.2), sixteen pixels at a time.
#pragma once

#include <cstdint>

#include "tracer/kernels/lanes/random.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/picture/tile_camera.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

struct CameraRays {
    Vec3 origin, direction;  // unit
};

// Columns and rows in the tile of pixels 16 group to 16 group + 15 (film.h).
HWY_INLINE Int tile_columns(int group) { return (lane_numbers() & Int(3)) + Int((group & 1) * 4); }
HWY_INLINE Int tile_rows(int group) { return shift_right<2>(lane_numbers()) + Int((group >> 1) * 4); }

// The pixels of a group that lie inside the picture.
HWY_INLINE Mask inside_picture(const TileCamera& camera, int group) {
    return (tile_columns(group) < Int(camera.width - camera.x)) & (tile_rows(group) < Int(camera.height - camera.y));
}

// The unit square to the unit disk, evenly by area (Shirley and Chiu, "A low distortion map between disk and square",
// 1997): squares around the middle become circles.
HWY_INLINE Point2 square_to_disk(Point2 square) {
    const Real x = mul_sub(square.x, Real(2.0f), Real(1.0f)), y = mul_sub(square.y, Real(2.0f), Real(1.0f));
    const Mask by_x = abs(x) > abs(y);
    const Real radius = select(by_x, x, y), other = select(by_x, y, x);
    const Real safe = select(radius == Real(0.0f), Real(1.0f), radius);
    // The angle from the axis, within +-pi / 4: a few terms of sine and cosine are exact to 1e-7.
    const Real a = Real(0.785398163f) * (other / safe), z = a * a;
    Real sine = mul_add(z, Real(2.7557319e-6f), Real(-1.9841270e-4f));
    sine = mul_add(sine, z, Real(8.3333333e-3f));
    sine = mul_add(sine, z, Real(-1.6666667e-1f));
    sine = mul_add(sine * z, a, a) * radius;
    Real cosine = mul_add(z, Real(2.4801587e-5f), Real(-1.3888889e-3f));
    cosine = mul_add(cosine, z, Real(4.1666667e-2f));
    cosine = mul_add(cosine, z, Real(-0.5f));
    cosine = mul_add(cosine, z, Real(1.0f)) * radius;
    return {select(by_x, cosine, sine), select(by_x, sine, cosine)};
}

// Sample `sample` of the pixels of a group.
HWY_INLINE CameraRays camera_rays(const TileCamera& camera, int group, std::uint32_t sample, std::uint32_t seed) {
    const Int column = tile_columns(group), row = tile_rows(group);
    Int key(0);
    if (sample != 0 || !camera.common_origin) key = pixel_key(column + Int(camera.x), row + Int(camera.y), seed);
    const Point2 in_pixel = pixel_sample(key, sample);
    const Real x = to_real(column) + in_pixel.x, y = to_real(row) + in_pixel.y;
    // Perspective: the direction to the sample's point on the image plane, one unit ahead. Orthographic: that point.
    const Vec3 point = mul_add(splat3(camera.right), x, mul_add(splat3(camera.down), y, splat3(camera.corner)));
    const Vec3 eye = splat3(camera.eye);
    if (camera.orthographic) return {point, splat3(camera.direction)};
    if (camera.common_origin) return {eye, normalize(point)};
    const Point2 disk = square_to_disk(aperture_sample(key, sample));
    const Vec3 aperture = mul_add(splat3(camera.aperture_right), disk.x, splat3(camera.aperture_up) * disk.y);
    return {eye + aperture, normalize(point * Real(camera.focal_distance) - aperture)};
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
