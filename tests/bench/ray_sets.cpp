#include "tests/bench/ray_sets.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tracer/ground/numeric.h"
#include "tracer/picture/camera.h"
#include "tracer/picture/film.h"

namespace raywalk::bench {

namespace {

constexpr float farthest = std::numeric_limits<float>::infinity();
constexpr glm::vec3 light{-6, 12, 8};

Camera bench_camera(const Picture& picture) {
    Viewer viewer;
    viewer.width = picture.width;
    viewer.height = picture.height;
    viewer.center = {-1, 4.5, 14};
    viewer.target = {0, 2, 0};
    viewer.up = {0, 1, 0};
    viewer.fovy_degrees = 45;
    return opening_camera(viewer, static_cast<double>(picture.width) / picture.height);
}

void set_ray(RaySet& set, std::size_t i, const glm::vec3& origin, const glm::vec3& direction, float t_min,
             float t_max) {
    for (int axis = 0; axis < 3; ++axis) {
        set.rays.origin(axis, i) = origin[axis];
        set.rays.direction(axis, i) = direction[axis];
    }
    set.rays.t_min(i) = t_min;
    set.rays.t_max(i) = t_max;
    ++set.live;
}

glm::vec3 origin_of(const RayBlocks& rays, std::size_t i) {
    return {rays.origin(0, i), rays.origin(1, i), rays.origin(2, i)};
}
glm::vec3 direction_of(const RayBlocks& rays, std::size_t i) {
    return {rays.direction(0, i), rays.direction(1, i), rays.direction(2, i)};
}

// Where a primary ray ended, moved off the surface to the side that it came from.
struct Place {
    glm::vec3 position, normal;  // normal: interpolated, on the side of the ray
};

Place place_of(const Geometry& geometry, const RayBlocks& rays, const HitBlocks& hits, std::size_t i) {
    const glm::vec3 direction = direction_of(rays, i);
    const auto triangles = static_cast<std::int32_t>(geometry.faces.size());
    const std::int32_t id = hits.id(i);
    glm::vec3 position = origin_of(rays, i) + hits.t(i) * direction, flat, smooth;
    if (id >= triangles) {
        const SphereShape& sphere = geometry.spheres[static_cast<std::size_t>(id - triangles)];
        flat = smooth = (position - sphere.center) / sphere.radius;
    } else {
        const auto f = static_cast<std::size_t>(id);
        glm::vec3 p[3];
        for (std::size_t c = 0; c < 3; ++c) p[c] = geometry.positions[geometry.faces[f][c]];
        flat = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        const auto& n = geometry.corner_normals[f];
        smooth = glm::normalize((1 - hits.u(i) - hits.v(i)) * n[0] + hits.u(i) * n[1] + hits.v(i) * n[2]);
    }
    if (glm::dot(flat, direction) > 0) flat = -flat;
    if (glm::dot(smooth, flat) < 0) smooth = -smooth;
    return {position + 1e-4f * flat, smooth};
}

std::size_t live_rays(const RayPacket& block) {
    std::size_t live = 0;
    for (int i = 0; i < packet_size; ++i) live += block.t_max[i] > block.t_min[i] ? 1 : 0;
    return live;
}

// A number in [0, 1) that depends on its arguments only.
float random_number(std::size_t i, std::uint32_t dimension) {
    auto x = static_cast<std::uint32_t>(i) * 0x9e3779b9u ^ dimension * 0x85ebca6bu;
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return static_cast<float>((x ^ (x >> 16)) >> 8) * 0x1p-24f;
}

// Around the unit vector n, with a density proportional to the cosine.
glm::vec3 cosine_direction(const glm::vec3& n, std::size_t i) {
    const float height = 1 - 2 * random_number(i, 0), turn = 2 * std::numbers::pi_v<float> * random_number(i, 1);
    const float r = std::sqrt(std::fmax(0.0f, 1 - height * height));
    const glm::vec3 sum = n + 0.9999f * glm::vec3(r * std::cos(turn), r * std::sin(turn), height);
    return glm::normalize(sum);
}

// The floor as a mirror: the eye's image below it looks at what is above it.
void reflect_in_floor(RaySet& set, const RaySet& primary, const HitBlocks& hits, std::size_t i) {
    const glm::vec3 eye = origin_of(primary.rays, i), d = direction_of(primary.rays, i);
    const float t = (floor_height - eye.y) / d.y;
    if (!(t > 0) || (hits.id(i) >= 0 && hits.t(i) < t)) return;
    set_ray(set, i, {eye.x, 2 * floor_height - eye.y, eye.z}, {d.x, -d.y, d.z}, t * (1 + 1e-5f), farthest);
}

}  // namespace

const KindTraits& traits_of(RayKind kind) {
    static constexpr KindTraits traits[] = {{"primary", false, true, 2.0, 3.0},
                                            {"point-light shadow", true, true, 1.8, 2.5},
                                            {"planar mirror", false, true, 2.2, 4.0},
                                            {"curved reflection", false, false, 1.15, 1.5},
                                            {"diffuse bounce", false, false, 1.25, 1.6}};
    return traits[static_cast<std::size_t>(kind)];
}

RaySet primary_rays(const Picture& picture) {
    const Camera camera = bench_camera(picture);
    const double half_width = camera.half_height * picture.width / picture.height;
    RaySet set{RayKind::primary,
               RayBlocks(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height))};
    std::size_t i = 0;
    for (int y = 0; y < picture.height; y += tile_size) {
        for (int x = 0; x < picture.width; x += tile_size) {
            for (int lane = 0; lane < tile_pixels; ++lane, ++i) {
                const double u = (2 * (x + tile_pixel_x(lane) + 0.5) / picture.width - 1) * half_width;
                const double v = (1 - 2 * (y + tile_pixel_y(lane) + 0.5) / picture.height) * camera.half_height;
                const glm::dvec3 d = glm::normalize(camera.direction + u * camera.right + v * camera.up);
                set_ray(set, i, glm::vec3(camera.eye), glm::vec3(d), 0, farthest);
            }
        }
    }
    return set;
}

RaySet secondary_rays(RayKind kind, const Geometry& geometry, const RaySet& primary, const HitBlocks& hits) {
    RaySet set{kind, RayBlocks(primary.rays.size())};
    for (std::size_t i = 0; i < primary.rays.size(); ++i) {
        set.rays.t_max(i) = 0;
        if (traits_of(kind).common_origin)  // also those that do not exist
            for (int axis = 0; axis < 3; ++axis)
                set.rays.origin(axis, i) = kind == RayKind::shadow ? light[axis] : primary.rays.origin(axis, i);
        if (kind == RayKind::planar_mirror) {
            set.rays.origin(1, i) = 2 * floor_height - primary.rays.origin(1, i);
            reflect_in_floor(set, primary, hits, i);
            continue;
        }
        if (hits.id(i) < 0) continue;
        const Place place = place_of(geometry, primary.rays, hits, i);
        const glm::vec3 d = direction_of(primary.rays, i);
        if (kind == RayKind::shadow)
            set_ray(set, i, light, place.position - light, 0, shadow_t_max);
        else if (kind == RayKind::curved_reflection)
            set_ray(set, i, place.position, d - 2 * glm::dot(d, place.normal) * place.normal, 0, farthest);
        else
            set_ray(set, i, place.position, cosine_direction(place.normal, i), 0, farthest);
    }
    // Blocks of 64 of which none exists are in nobody's queue.
    RaySet compact{kind, RayBlocks(), set.live};
    for (const RayPacket& block : set.rays.blocks())
        if (live_rays(block) > 0) compact.rays.add(block);
    return compact;
}

RaySet thinned(const RaySet& set, std::size_t step) {
    RaySet thin{set.kind, RayBlocks()};
    for (std::size_t b = 0; b < set.rays.blocks().size(); b += step) {
        thin.rays.add(set.rays.blocks()[b]);
        thin.live += live_rays(set.rays.blocks()[b]);
    }
    return thin;
}

}  // namespace raywalk::bench
