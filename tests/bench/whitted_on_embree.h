// The same pictures by a plain renderer on Embree: rays in packets of sixteen, shading one hit at a time.
#pragma once

#include <embree3/rtcore.h>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/picture/film.h"
#include "tracer/rendering/renderer.h"

namespace raywalk::bench {

// One sample through every pixel's centre, all points of every light, pinhole or orthographic. `scene` gives planes,
// surfaces and lights, `embree` holds its triangles and spheres as geometries 0 and 1.
FloatImage render_on_embree(const CompiledScene& scene, RTCScene embree, const View& view);

}  // namespace raywalk::bench
