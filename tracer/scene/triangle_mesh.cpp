#include "tracer/scene/triangle_mesh.h"

#include <algorithm>

namespace raywalk {

std::string placement_problem(const TriangleMesh& mesh) {
    if (mesh.positions.empty()) return "it has no vertices";
    if (mesh.faces.empty()) return "it has no faces";
    const auto same = [&](const glm::vec3& p) { return p == mesh.positions.front(); };
    if (std::all_of(mesh.positions.begin(), mesh.positions.end(), same)) return "all its vertices are one point";
    return {};
}

}  // namespace raywalk
