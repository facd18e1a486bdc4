// What was hit: position, normals, material and colour of sixteen hits (spec 4.4, 4.6).
#pragma once

#include <cstddef>

#include "tracer/compiled/compiled_scene.h"
#include "tracer/ground/numeric.h"
#include "tracer/kernels/lanes/math.h"
#include "tracer/kernels/lanes/records.h"
#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/shading/texture.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Sixteen rays and what they hit; id, t, u, v as in RayHit. Directions are unit vectors.
struct HitLanes {
    Mask active;  // those with a hit
    Vec3 origin, direction;
    Real t, u, v;
    Int id;
};

struct SurfaceLanes {
    Vec3 position;
    Vec3 geometric_normal;  // unit; outward for spheres, else any side
    Vec3 normal;            // unit; for shading
    Real offset;            // how far from the surface rays start: beyond the error of the position
    Vec3 lift;              // from a smooth triangle up to the curved surface that its normals mean, else 0
    Int surface;            // index into CompiledScene::surfaces
    Mask sphere, plane, smooth;
    Real refraction_index;  // spheres: inside
};

HWY_INLINE Vec3 turned_against(Vec3 direction, Vec3 normal) {
    return select(dot(normal, direction) > Real(0.0f), -normal, normal);
}

// The interpolated vertex normal, on the side of the face that the ray comes from (s.normal before); the face's where
// the vertex normals cancel. And the lift: the point is projected onto the plane of each vertex and its normal, and the
// projections above it are interpolated (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021).
HWY_INLINE void make_smooth(const CompiledScene& scene, const HitLanes& hit, SurfaceLanes& s) {
    const Records normals(scene.vertex_normals.data(), s.smooth, hit.id);
    const Records corners(scene.smooth_corners.data(), s.smooth, hit.id);
    const auto corner = [](const Records& of, int i)
                            HWY_ATTR { return of.vector(sizeof(float) * 3 * static_cast<std::size_t>(i)); };
    const Vec3 n0 = corner(normals, 0), n1 = corner(normals, 1), n2 = corner(normals, 2);
    const Real w0 = Real(1.0f) - hit.u - hit.v;
    const Vec3 sum = mul_add(n2, hit.v, mul_add(n1, hit.u, n0 * w0));
    const Real squared_length = dot(sum, sum), zero(0.0f);
    const Mask known = s.smooth & (squared_length > Real(1e-12f));
    const Mask inward = dot(sum, s.normal) < zero;
    const Vec3 facing = s.normal, outward = sum * (Real(1.0f) / sqrt(squared_length));
    s.normal = select(known, select(inward, -outward, outward), facing);

    const auto projection = [&](int i, Vec3 n, Real weight) HWY_ATTR {
        const Real height = dot(s.position - corner(corners, i), n);
        return n * (weight * select(inward, max(height, zero), min(height, zero)));
    };
    const Vec3 lift = -(projection(0, n0, w0) + projection(1, n1, hit.u) + projection(2, n2, hit.v));
    s.lift = select(known & (dot(lift, facing) > zero), lift, s.lift);
}

// Where the hits are and how the surface lies there. Lanes that are not active hold anything.
HWY_INLINE SurfaceLanes surface_at(const CompiledScene& scene, const HitLanes& hit) {
    SurfaceLanes s;
    s.position = mul_add(hit.direction, hit.t, hit.origin);
    s.refraction_index = Real(1.0f);
    s.surface = Int(0);
    s.offset = Real(surface_offset) * max(max(abs(s.position.x), abs(s.position.y)), max(abs(s.position.z), hit.t));
    s.lift = Vec3{Real(0.0f), Real(0.0f), Real(0.0f)};
    s.geometric_normal = s.normal = Vec3{Real(0.0f), Real(0.0f), Real(1.0f)};
    const Int first_sphere(scene.triangle_count), first_plane(scene.triangle_count + scene.sphere_count);
    const Mask triangle = hit.active & (hit.id < first_sphere);
    s.plane = and_not(hit.id < first_plane, hit.active);
    s.sphere = and_not(triangle | s.plane, hit.active);
    s.smooth = triangle & (hit.id < Int(scene.smooth_count));

    if (any(triangle)) {
        const Records records(scene.triangles.data(), triangle, hit.id);
        s.geometric_normal = records.vector(offsetof(TriangleRecord, normal));
        s.surface = records.integer(offsetof(TriangleRecord, surface));
        const Records surfaces(scene.surfaces.data(), triangle, s.surface);
        s.offset = max(s.offset, select(triangle, surfaces.real(offsetof(SurfaceRecord, triangle_error)), Real(0.0f)));
    }
    if (any(s.plane)) {
        const Records records(scene.planes.data(), s.plane, hit.id - first_plane);
        s.geometric_normal = select(s.plane, records.vector(offsetof(PlaneRecord, normal)), s.geometric_normal);
        s.surface = select(s.plane, records.integer(offsetof(PlaneRecord, surface)), s.surface);
    }
    if (any(s.sphere)) {
        const Records records(scene.spheres.data(), s.sphere, hit.id - first_sphere);
        const Vec3 center = records.vector(offsetof(SphereRecord, center));
        // A sphere that is smaller than the rounding of its place has hits at its very centre: it faces the ray.
        const Vec3 away = s.position - center;
        const Real squared_distance = dot(away, away);
        const Vec3 outward =
            select(squared_distance > Real(1e-36f), away * (Real(1.0f) / sqrt(squared_distance)), -hit.direction);
        // Back onto the sphere: the hit distance is good to a few e of the ray's length, the radius is exact.
        const Real radius = records.real(offsetof(SphereRecord, radius));
        s.position = select(s.sphere, mul_add(outward, radius, center), s.position);
        const Real reach = max(abs(center.x), max(abs(center.y), abs(center.z))) + radius;
        s.offset = select(s.sphere, max(s.offset, reach * Real(sphere_offset)), s.offset);
        s.geometric_normal = select(s.sphere, outward, s.geometric_normal);
        s.surface = select(s.sphere, records.integer(offsetof(SphereRecord, surface)), s.surface);
        s.refraction_index = select(s.sphere, records.real(offsetof(SphereRecord, refraction_index)), Real(1.0f));
    }
    s.normal = turned_against(hit.direction, s.geometric_normal);
    if (any(s.smooth)) make_smooth(scene, hit, s);
    return s;
}

// Surface coordinates of the lanes that have any: planes and spheres (spec 4.6).
struct SurfaceCoordinates {
    Real u, v;
};
HWY_INLINE SurfaceCoordinates coordinates_at(const CompiledScene& scene, const HitLanes& hit, const SurfaceLanes& s) {
    SurfaceCoordinates c = {Real(0.0f), Real(0.0f)};
    if (any(s.plane)) {
        const Records records(scene.planes.data(), s.plane, hit.id - Int(scene.triangle_count + scene.sphere_count));
        c.u =
            dot(s.position, records.vector(offsetof(PlaneRecord, u_axis))) + records.real(offsetof(PlaneRecord, shift));
        c.v = dot(s.position, records.vector(offsetof(PlaneRecord, v_axis))) +
              records.real(offsetof(PlaneRecord, shift) + sizeof(float));
    }
    if (any(s.sphere)) {
        const Real per_turn(0.159154943f);
        c.u = select(s.sphere, atan2(s.normal.y, s.normal.x) * per_turn, c.u);
        c.v = select(s.sphere, asin(s.normal.z) * per_turn, c.v);
    }
    return c;
}

// How the hits look.
struct MaterialLanes {
    Vec3 color;
    Real ambient, specular, reflection, transmission;
    Int shininess;
};
HWY_INLINE MaterialLanes material_at(const CompiledScene& scene, const HitLanes& hit, const SurfaceLanes& s) {
    const Records records(scene.surfaces.data(), hit.active, s.surface);
    MaterialLanes m;
    m.ambient = records.real(offsetof(SurfaceRecord, ambient));
    m.specular = records.real(offsetof(SurfaceRecord, specular));
    m.reflection = records.real(offsetof(SurfaceRecord, reflection));
    m.transmission = records.real(offsetof(SurfaceRecord, transmission));
    m.shininess = records.integer(offsetof(SurfaceRecord, shininess));
    m.color = records.vector(offsetof(SurfaceRecord, color));

    const Int pattern = records.integer(offsetof(SurfaceRecord, pattern));
    const Mask grid = hit.active & (pattern == Int(static_cast<std::int32_t>(Pattern::grid)));
    const Mask image = hit.active & (pattern == Int(static_cast<std::int32_t>(Pattern::image)));
    if (none(grid | image)) return m;
    const SurfaceCoordinates at = coordinates_at(scene, hit, s);
    const Real scale = records.real(offsetof(SurfaceRecord, scale));
    if (any(grid)) {
        const Real grey = grid_color(at.u, at.v, scale);
        m.color = select(grid, Vec3{grey, grey, grey}, m.color);
    }
    if (any(image)) {
        const Int index = records.integer(offsetof(SurfaceRecord, image));
        m.color = select(image, image_color(scene, image, index, at.u, at.v, scale), m.color);
    }
    return m;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
