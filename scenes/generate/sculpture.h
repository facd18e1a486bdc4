// The meshes made for the shipped scenes, beside the teapot.
#pragma once

#include "scenes/generate/mesh.h"

namespace generate {

// A ring of saddles, closed and of many holes: more than 100,000 triangles at a detail of 1, growing with its square.
// It stands upright: its axis is z.
Mesh saddle_ring(float detail);

// A trefoil knot of a round cross-section, coarse, without normals: `along` x `around` quads.
Mesh trefoil_knot(int along, int around);

}  // namespace generate
