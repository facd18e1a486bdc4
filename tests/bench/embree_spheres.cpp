#include "tests/bench/embree_spheres.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace raywalk::bench {

namespace {

template <int width>
struct LaneTypes {
    typedef float Real __attribute__((vector_size(4 * width)));
    typedef std::int32_t Int __attribute__((vector_size(4 * width)));
};

template <int width, class Vector>
Vector read(const void* from) {
    Vector v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

template <int width, class Real>
Real square_root(Real a) {
    Real root;
    for (int i = 0; i < width; ++i) root[i] = __builtin_sqrtf(a[i]);
    return root;
}

// The same formula as the tracer's. Returns which lanes hit, and where.
template <int width>
auto sphere_hits(const SphereShape& sphere, const RTCRayNt<width>& ray, const int* valid,
                 typename LaneTypes<width>::Real& t) {
    using Real = typename LaneTypes<width>::Real;
    using Int = typename LaneTypes<width>::Int;
    const Real dx = read<width, Real>(ray.dir_x), dy = read<width, Real>(ray.dir_y), dz = read<width, Real>(ray.dir_z);
    const Real cx = sphere.center.x - read<width, Real>(ray.org_x), cy = sphere.center.y - read<width, Real>(ray.org_y),
               cz = sphere.center.z - read<width, Real>(ray.org_z);
    const Real inverse = 1.0f / (dx * dx + dy * dy + dz * dz);
    const Real middle = (cx * dx + cy * dy + cz * dz) * inverse;
    const Real px = cx - dx * middle, py = cy - dy * middle, pz = cz - dz * middle;
    const Real discriminant = sphere.radius * sphere.radius - (px * px + py * py + pz * pz);
    const Int meets = discriminant >= 0.0f;
    const Real half = square_root<width>((meets ? discriminant : discriminant * 0.0f) * inverse);
    const Real start = read<width, Real>(ray.tnear);
    const Real first = middle - half;
    t = first > start ? first : middle + half;
    return Int(read<width, Int>(valid) & meets & Int(t > start) & Int(t < read<width, Real>(ray.tfar)));
}

template <class Int>
bool none_of(Int mask, int width) {
    std::int32_t any = 0;
    for (int i = 0; i < width; ++i) any |= mask[i];
    return any == 0;
}

// The normal is not written: hits of the tracer have none either.
template <int width>
void intersect_spheres(const RTCIntersectFunctionNArguments& a) {
    using Real = typename LaneTypes<width>::Real;
    using Int = typename LaneTypes<width>::Int;
    auto& rayhit = *reinterpret_cast<RTCRayHitNt<width>*>(a.rayhit);
    Real t;
    const Int hit =
        sphere_hits<width>(static_cast<const SphereShape*>(a.geometryUserPtr)[a.primID], rayhit.ray, a.valid, t);
    if (none_of(hit, width)) return;
    const auto write = [&](auto* to, auto value) {
        using Vector = decltype(value);
        const Vector merged = hit ? value : read<width, Vector>(to);
        __builtin_memcpy(to, &merged, sizeof merged);
    };
    write(rayhit.ray.tfar, t);
    write(rayhit.hit.u, Real{});
    write(rayhit.hit.v, Real{});
    write(rayhit.hit.primID, Int{} + static_cast<std::int32_t>(a.primID));
    write(rayhit.hit.geomID, Int{} + static_cast<std::int32_t>(a.geomID));
}

template <int width>
void occlude_spheres(const RTCOccludedFunctionNArguments& a) {
    using Real = typename LaneTypes<width>::Real;
    using Int = typename LaneTypes<width>::Int;
    auto& ray = *reinterpret_cast<RTCRayNt<width>*>(a.ray);
    Real t;
    const Int hit = sphere_hits<width>(static_cast<const SphereShape*>(a.geometryUserPtr)[a.primID], ray, a.valid, t);
    const Real merged = hit ? Real{} - std::numeric_limits<float>::infinity() : read<width, Real>(ray.tfar);
    __builtin_memcpy(ray.tfar, &merged, sizeof merged);
}

// One ray, in plain numbers.
bool sphere_hit(const SphereShape& sphere, const RTCRay& ray, float& t) {
    const float cx = sphere.center.x - ray.org_x, cy = sphere.center.y - ray.org_y, cz = sphere.center.z - ray.org_z;
    const float inverse = 1.0f / (ray.dir_x * ray.dir_x + ray.dir_y * ray.dir_y + ray.dir_z * ray.dir_z);
    const float middle = (cx * ray.dir_x + cy * ray.dir_y + cz * ray.dir_z) * inverse;
    const float px = cx - ray.dir_x * middle, py = cy - ray.dir_y * middle, pz = cz - ray.dir_z * middle;
    const float discriminant = sphere.radius * sphere.radius - (px * px + py * py + pz * pz);
    if (discriminant < 0) return false;
    const float half = __builtin_sqrtf(discriminant * inverse);
    t = middle - half > ray.tnear ? middle - half : middle + half;
    return t > ray.tnear && t < ray.tfar;
}

void intersect_callback(const RTCIntersectFunctionNArguments* a) {
    if (a->N == 16) return intersect_spheres<16>(*a);
    if (a->N == 8) return intersect_spheres<8>(*a);
    if (a->N != 1 || a->valid[0] == 0) return;
    auto& rayhit = *reinterpret_cast<RTCRayHit*>(a->rayhit);
    float t;
    if (!sphere_hit(static_cast<const SphereShape*>(a->geometryUserPtr)[a->primID], rayhit.ray, t)) return;
    rayhit.ray.tfar = t;
    rayhit.hit.u = rayhit.hit.v = 0;
    rayhit.hit.primID = a->primID;
    rayhit.hit.geomID = a->geomID;
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
    if (a->N == 16) return occlude_spheres<16>(*a);
    if (a->N == 8) return occlude_spheres<8>(*a);
    if (a->N != 1 || a->valid[0] == 0) return;
    auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
    float t;
    if (sphere_hit(static_cast<const SphereShape*>(a->geometryUserPtr)[a->primID], ray, t))
        ray.tfar = -std::numeric_limits<float>::infinity();
}

void bounds_callback(const RTCBoundsFunctionArguments* a) {
    const SphereShape& s = static_cast<const SphereShape*>(a->geometryUserPtr)[a->primID];
    *a->bounds_o = {s.center.x - s.radius, s.center.y - s.radius, s.center.z - s.radius, 0,
                    s.center.x + s.radius, s.center.y + s.radius, s.center.z + s.radius, 0};
}

}  // namespace

RTCGeometry make_sphere_geometry(RTCDevice device, std::span<const SphereShape> spheres) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
    rtcSetGeometryUserData(geometry, const_cast<SphereShape*>(spheres.data()));
    rtcSetGeometryBoundsFunction(geometry, bounds_callback, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_callback);
    rtcSetGeometryOccludedFunction(geometry, occluded_callback);
    return geometry;
}

}  // namespace raywalk::bench
