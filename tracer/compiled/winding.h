// Faces that are listed the other way round than their neighbours: their normals would cancel those around them.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// By face, 1 where its corners are to be taken in the other order so that the faces on the two sides of each edge
// agree; empty where no face is. Of a part that is connected by such edges and does not agree, all faces are to point
// outwards if it is closed; else most of them stay as they are. Edges of three faces or more connect nothing.
std::vector<std::uint8_t> faces_to_turn(const TriangleMesh& mesh);

}  // namespace raywalk
