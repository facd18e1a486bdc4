// Colours of surfaces: pure, grid, image (spec 4.7), sixteen hits at a time.
#pragma once

#include "tracer/compiled/compiled_scene.h"
#include "tracer/kernels/lanes/records.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// White where floor(u d) + floor(v d) is odd, else black. In floats all the way: no distance overflows.
HWY_INLINE Real grid_color(Real u, Real v, Real density) {
    const Real cell = floor(u * density) + floor(v * density);
    const Real half = cell * Real(0.5f);
    return select(floor(half) < half, Real(1.0f), Real(0.0f));
}

// Index of the nearest texel: row floor(frac(u / size) * rows), column floor(frac(v / size) * columns).
HWY_INLINE Int texel_index(const Records& images, Real u, Real v, Real inverse_size) {
    const Int columns = images.integer(offsetof(ImageRecord, width)),
              rows = images.integer(offsetof(ImageRecord, height));
    const Real a = u * inverse_size, b = v * inverse_size;
    // A fraction may round up to 1, and a coordinate that is not finite has none: both stay inside the image.
    const auto cell = [](Real fraction, Int count) HWY_ATTR {
        const Real limited = max(min(fraction * to_real(count), to_real(count - Int(1))), Real(0.0f));
        return truncate_to_int(limited);
    };
    return images.integer(offsetof(ImageRecord, first_texel)) + cell(a - floor(a), rows) * columns +
           cell(b - floor(b), columns);
}

HWY_INLINE Vec3 image_color(const CompiledScene& scene, Mask active, Int image, Real u, Real v, Real inverse_size) {
    const Records images(scene.images.data(), active, image);
    const Int texel = gather(reinterpret_cast<const std::int32_t*>(scene.texels.data()),
                             select(active, texel_index(images, u, v, inverse_size), Int(0)));
    const Real scale(1.0f / 255.0f);
    return {to_real(texel & Int(255)) * scale, to_real(shift_right<8>(texel) & Int(255)) * scale,
            to_real(shift_right<16>(texel) & Int(255)) * scale};
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
