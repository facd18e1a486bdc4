// Polygons of a mesh that are more than triangles: read as fans from their first corner, cut anew where that is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tracer/scene/triangle_mesh.h"

namespace raywalk {

// Polygons of the same number of corners (4 or more) whose fans, of corners - 2 triangles, follow one another.
struct PolygonRun {
    std::size_t first_face, count;
    std::uint32_t corners;
};

// Runs by ascending faces.
class PolygonRuns {
  public:
    void add(std::size_t first_face, std::uint32_t corners) { add({first_face, 1, corners}); }
    // Those of a chunk that follows `faces_before` faces.
    void append(const PolygonRuns& of_chunk, std::size_t faces_before);
    void clear() { runs_.clear(); }
    [[nodiscard]] const std::vector<PolygonRun>& runs() const { return runs_; }

  private:
    void add(const PolygonRun& run) {
        if (!runs_.empty()) {
            PolygonRun& last = runs_.back();
            if (last.corners == run.corners && last.first_face + last.count * (last.corners - 2) == run.first_face) {
                last.count += run.count;
                return;
            }
        }
        runs_.push_back(run);
    }

    std::vector<PolygonRun> runs_;
};

// Replaces fans that leave their polygon (it is concave) by as many triangles that fill it. The others stay as they
// are. Returns how many polygons keep a wrong fan because cutting all of them takes too long.
std::size_t cut_concave_polygons(TriangleMesh& mesh, const PolygonRuns& polygons);

}  // namespace raywalk
