// Martin Newell's teapot (1975) from its bicubic Bezier patches.
#pragma once

#include "scenes/generate/mesh.h"

namespace generate {

// 32 patches of `steps` x `steps` quads. y is up; the pot is 3.15 high and stands on y = 0.
Mesh teapot(int steps);

}  // namespace generate
