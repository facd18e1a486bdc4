#include "tests/bench/referee.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace raywalk::bench {

namespace {

// A point may be off by twelve roundings of its largest coordinate: those of its own coordinates, of the ray's origin
// and direction, of a handful of operations on them, and what triangles grow by to leave no gap (triangle_growth).
constexpr double point_error = 12 * 0x1p-24;

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

Referee::Referee(const Geometry& geometry, const RaySet& set, std::size_t ray)
    : t_min_(set.rays.t_min(ray)), t_max_(set.rays.t_max(ray)) {
    for (int axis = 0; axis < 3; ++axis) {
        origin_[axis] = set.rays.origin(axis, ray);
        direction_[axis] = set.rays.direction(axis, ray);
    }
    for (const auto& face : geometry.faces)
        triangle({geometry.positions[face[0]], geometry.positions[face[1]], geometry.positions[face[2]]});
    for (const SphereShape& s : geometry.spheres) sphere(s.center, s.radius);
}

// Keeps a candidate whose distance may be within the ray.
void Referee::consider(const Candidate& candidate, bool inside_surely) {
    const double t = candidate.t, tolerance = candidate.tolerance;
    if (!(t > t_min_ - tolerance && t < t_max_ + tolerance)) return;
    const bool within = t > t_min_ + tolerance && t < t_max_ - tolerance;
    candidates_.push_back({t, tolerance, inside_surely && within});
}

void Referee::triangle(const glm::dvec3 (&corners)[3]) {
    const glm::dvec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
    const glm::dvec3 normal = glm::cross(edge1, edge2);
    const double area = glm::length(normal), speed = glm::length(direction_);
    const double slope = glm::dot(normal, direction_);
    const double cosine = std::abs(slope) / (area * speed);
    if (!(cosine > 0)) return;  // no area, or seen from its edge: nobody can be sure of a hit
    const double t = glm::dot(normal, corners[0] - origin_) / slope;
    const glm::dvec3 p = origin_ + t * direction_ - corners[0];
    const double v = glm::dot(glm::cross(edge1, p), normal) / (area * area);
    const double u = glm::dot(glm::cross(p, edge2), normal) / (area * area);

    const double off =
        point_error * std::max({largest(origin_), largest(corners[0]), largest(corners[1]), largest(corners[2])});
    // Across the triangle a point moves by off / cosine, and a weight by that over the height on its edge.
    const double lengths[] = {glm::length(corners[2] - corners[1]), glm::length(edge2), glm::length(edge1)};
    const double weights[] = {1 - u - v, u, v};
    bool possible = true, certain = true;
    for (int i = 0; i < 3; ++i) {
        const double slack = off / cosine * lengths[i] / area;
        possible &= weights[i] > -slack;
        certain &= weights[i] > slack;
    }
    if (possible) consider({t, off / (cosine * speed), false}, certain);
}

void Referee::sphere(const glm::dvec3& center, double radius) {
    const double speed = glm::length(direction_);
    const glm::dvec3 d = direction_ / speed, to_center = center - origin_;
    const double along = glm::dot(to_center, d), off = point_error * std::max(largest(origin_), largest(center));
    const double apart = glm::length(to_center - along * d);
    if (apart > radius + off) return;
    const double half = std::sqrt(std::max(0.0, radius * radius - apart * apart));
    // Near the silhouette the half chord moves by much: from `half` to that of a sphere larger or smaller by `off`.
    const double wider = std::sqrt((radius + off) * (radius + off) - apart * apart);
    const double tolerance = (std::abs(wider - half) + off) / speed;
    const bool surely = apart < radius - off;
    consider({(along - half) / speed, tolerance, false}, surely);
    consider({(along + half) / speed, tolerance, false}, surely);
}

bool Referee::allows(bool any_hit, bool hit, double distance) const {
    const auto certain = [](const Candidate& c) { return c.certain; };
    if (!hit) return std::ranges::none_of(candidates_, certain);
    if (any_hit) return !candidates_.empty();
    const bool there = std::ranges::any_of(
        candidates_, [&](const Candidate& c) { return std::abs(c.t - distance) <= 2 * c.tolerance; });
    const bool first = std::ranges::none_of(
        candidates_, [&](const Candidate& c) { return c.certain && c.t + 2 * c.tolerance < distance; });
    return there && first;
}

}  // namespace raywalk::bench
