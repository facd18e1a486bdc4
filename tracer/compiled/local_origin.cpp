#include "tracer/compiled/local_origin.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>

namespace raywalk {

namespace {

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

glm::dvec3 local_origin(const Scene& scene) {
    glm::dvec3 lower = scene.viewer.center, upper = scene.viewer.center;
    const auto include = [&](const glm::dvec3& point, double radius) {
        lower = glm::min(lower, point - radius);
        upper = glm::max(upper, point + radius);
    };
    for (const Sphere& sphere : scene.spheres) include(sphere.center, sphere.radius);
    for (const Mesh& mesh : scene.meshes) include(mesh.center, mesh.radius);
    for (const Face& face : scene.faces)
        for (const glm::dvec3& corner : {face.a, face.b, face.c}) include(corner, 0);
    const glm::dvec3 middle = (lower + upper) * 0.5;
    return largest(middle) > far_away * largest(upper - lower) ? glm::round(middle) : glm::dvec3(0);
}

Scene moved_to(const glm::dvec3& origin, Scene scene) {
    scene.viewer.center -= origin;
    scene.viewer.target -= origin;
    for (Light& light : scene.lights) light.origin -= origin;
    for (Plane& plane : scene.planes) plane.offset -= glm::dot(plane.normal, origin);
    for (Sphere& sphere : scene.spheres) sphere.center -= origin;
    for (Mesh& mesh : scene.meshes) mesh.center -= origin;
    for (Face& face : scene.faces)
        for (glm::dvec3* corner : {&face.a, &face.b, &face.c}) *corner -= origin;
    return scene;
}

std::vector<Diagnostic> small_shape_warnings(const Scene& scene) {
    const glm::dvec3 origin = local_origin(scene);
    std::size_t count = 0;
    const auto note = [&](const glm::dvec3& center, double radius) {
        count += radius < largest(center - origin) * 0x1p-20 ? 1 : 0;
    };
    for (const Sphere& sphere : scene.spheres) note(sphere.center, sphere.radius);
    for (const Mesh& mesh : scene.meshes) note(mesh.center, mesh.radius);
    if (count == 0) return {};
    return {warning_at({.file = scene.file.string()},
                       std::to_string(count) + (count == 1 ? " shape is" : " shapes are") +
                           " smaller than a millionth of the distance from the middle of the scene",
                       "rounding shows on them; put what is small near the middle, or leave out what is far")};
}

}  // namespace raywalk
