#include "tests/oracle/shading_naive.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

namespace raywalk {

namespace {

constexpr double mu = 0.02, infinity = std::numeric_limits<double>::infinity();
constexpr double nearest_distance = 1e-7;  // rays leave their surface by this

struct Ray {
    glm::dvec3 origin, direction;
};

struct Hit {
    double t = infinity;
    glm::dvec3 normal{0};  // outward for spheres
    const Texture* texture = nullptr;
    const Sphere* sphere = nullptr;
    const Plane* plane = nullptr;
};

void meet(const Sphere& sphere, const Ray& ray, Hit& hit) {
    const glm::dvec3 c = sphere.center - ray.origin;
    const double b = glm::dot(c, ray.direction);
    const double discriminant = b * b - glm::dot(c, c) + sphere.radius * sphere.radius;
    if (discriminant < 0) return;
    for (const double t : {b - std::sqrt(discriminant), b + std::sqrt(discriminant)})
        if (t > nearest_distance && t < hit.t) {
            const glm::dvec3 normal = (ray.origin + t * ray.direction - sphere.center) / sphere.radius;
            hit = {.t = t, .normal = normal, .texture = &sphere.texture, .sphere = &sphere, .plane = nullptr};
        }
}

void meet(const Plane& plane, const Ray& ray, Hit& hit) {
    const double t = (plane.offset - glm::dot(ray.origin, plane.normal)) / glm::dot(ray.direction, plane.normal);
    if (t > nearest_distance && t < hit.t)
        hit = {.t = t, .normal = plane.normal, .texture = &plane.texture, .sphere = nullptr, .plane = &plane};
}

void meet(const Face& face, const Ray& ray, Hit& hit) {
    const glm::dvec3 normal = glm::cross(face.b - face.a, face.c - face.a);
    const double t = glm::dot(face.a - ray.origin, normal) / glm::dot(ray.direction, normal);
    if (!(t > nearest_distance && t < hit.t)) return;
    const glm::dvec3 p = ray.origin + t * ray.direction;
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
    };
    if (inside(face.a, face.b) && inside(face.b, face.c) && inside(face.c, face.a))
        hit = {.t = t, .normal = glm::normalize(normal), .texture = &face.texture, .sphere = nullptr, .plane = nullptr};
}

Hit nearest(const Scene& scene, const Ray& ray) {
    Hit hit;
    for (const Sphere& sphere : scene.spheres) meet(sphere, ray, hit);
    for (const Plane& plane : scene.planes) meet(plane, ray, hit);
    for (const Face& face : scene.faces) meet(face, ray, hit);
    return hit;
}

// Axis-aligned planes only.
glm::dvec2 plane_coordinates(const glm::dvec3& n, const glm::dvec3& p) {
    glm::dvec3 x(-n.y, n.x, 0), y(0, -n.z, n.y);
    if (glm::length(x) == 0) x = {-n.z, 0, n.x};
    if (glm::length(y) == 0) y = {-n.z, 0, n.x};
    return {glm::dot(p, x), glm::dot(p, y)};
}

glm::dvec3 color_at(const Hit& hit, const glm::dvec3& p, const glm::dvec3& turned_normal) {
    if (const auto* pure = std::get_if<PureTexture>(&hit.texture->pattern)) return pure->color;
    const double density = std::get<GridTexture>(hit.texture->pattern).density;
    glm::dvec2 uv;
    if (hit.plane != nullptr)
        uv = plane_coordinates(hit.plane->normal, p);
    else
        uv = glm::dvec2(std::atan2(turned_normal.y, turned_normal.x), std::asin(turned_normal.z)) /
             (2 * std::numbers::pi);
    const double cell = std::floor(uv.x * density) + std::floor(uv.y * density);
    return glm::dvec3(std::fmod(std::abs(cell), 2) == 1 ? 1 : 0);
}

// Points of light with their intensities (spec 4.5).
template <class Visit>
void for_each_point(const Scene& scene, const Visit& visit) {
    for (const Light& light : scene.lights) {
        const int n = light.area ? light.area->n : 1;
        const double radius = light.area ? light.area->radius : 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / n;
                const glm::dvec3 offset(std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b));
                visit(light.origin + radius * offset, light.color * light.intensity / static_cast<double>(n * n));
            }
    }
}

glm::dvec3 radiance(const Scene& scene, const Ray& ray, int depth, double length, double medium) {
    if (depth > 5) return glm::dvec3(0);
    const Hit hit = nearest(scene, ray);
    if (hit.texture == nullptr) return glm::dvec3(0);
    const glm::dvec3 p = ray.origin + hit.t * ray.direction;
    const bool entering = glm::dot(hit.normal, ray.direction) < 0;
    const glm::dvec3 n = entering ? hit.normal : -hit.normal;
    const double s = length + hit.t;
    const Material& m = hit.texture->material;
    const glm::dvec3 color = color_at(hit, p, n);

    glm::dvec3 local(0);
    for_each_point(scene, [&](const glm::dvec3& light, const glm::dvec3& intensity) {
        const glm::dvec3 l = glm::normalize(light - p);
        const double distance = glm::length(light - p);
        // From the light, as far as the surface: what lies on the surface itself does not hide it.
        if (nearest(scene, {p + l * nearest_distance, l}).t < distance) return;
        const double ln = glm::dot(l, n);
        const double rv = glm::dot(2 * ln * n - l, -ray.direction);
        local += intensity * std::exp(-mu * distance) *
                 (color * std::max(0.0, ln) + m.specular * std::pow(std::max(0.0, rv), m.shininess));
    });
    glm::dvec3 result = glm::dvec3(0.2 * m.ambient) + std::exp(-mu * s) * local;

    const glm::dvec3 mirrored = ray.direction - 2 * glm::dot(ray.direction, n) * n;
    if (m.reflection > 0) result += m.reflection * radiance(scene, {p, mirrored}, depth + 1, s, medium);
    if (m.transmission > 0) {
        glm::dvec3 direction = ray.direction;
        double next_medium = medium;
        if (hit.sphere != nullptr) {
            next_medium = entering ? hit.sphere->refraction_index : 1.0;
            const double eta = medium / next_medium, cosine = -glm::dot(ray.direction, n);
            const double k = 1 - eta * eta * (1 - cosine * cosine);
            direction = k < 0 ? mirrored : eta * ray.direction + (eta * cosine - std::sqrt(std::max(k, 0.0))) * n;
            if (k < 0) next_medium = medium;
        }
        result += m.transmission * radiance(scene, {p, glm::normalize(direction)}, depth + 1, s, next_medium);
    }
    return result;
}

}  // namespace

glm::dvec3 naive_radiance(const Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction) {
    return radiance(scene, {origin, direction}, 0, 0, 1.0);
}

}  // namespace raywalk
