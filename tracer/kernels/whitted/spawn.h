// Mirrored and refracted rays (spec 4.4): hits of one level make the rays of the next.
#pragma once

#include <cstdint>

#include "tracer/kernels/lanes/vectors.h"
#include "tracer/kernels/shading/surface.h"
#include "tracer/kernels/tile_scratch.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {

// Rays that go on from sixteen hits.
struct SpawnedRays {
    Mask active;
    Vec3 direction;
    Real weight, medium;
    Int mirror;  // RayQueue::mirror
};

HWY_INLINE Vec3 mirrored(Vec3 direction, Vec3 normal) {
    return mul_add(normal, Real(-2.0f) * dot(direction, normal), direction);
}

// Snell's law: by the index of the medium that the ray is in and, entering a sphere, the sphere's, leaving it,
// vacuum's. Total reflection reflects. Everything but a sphere lets the ray go straight on. `total`: the lanes
// reflected so.
HWY_INLINE SpawnedRays refracted(const HitLanes& hit, const SurfaceLanes& s, Mask active, Real weight, Real medium,
                                 Mask& total) {
    const Real cosine = -dot(hit.direction, s.normal);  // of the incoming ray, >= 0: normals of spheres are turned
    const Mask entering = dot(hit.direction, s.geometric_normal) < Real(0.0f);
    const Real index = select(entering, s.refraction_index, Real(1.0f));
    const Real eta = medium / index;
    const Real squared = neg_mul_add(eta * eta, neg_mul_add(cosine, cosine, Real(1.0f)), Real(1.0f));
    total = active & s.sphere & (squared < Real(0.0f));
    const Vec3 bent = mul_add(s.normal, mul_sub(eta, cosine, sqrt(max(squared, Real(0.0f)))), hit.direction * eta);
    SpawnedRays rays;
    rays.active = active;
    rays.direction = select(total, mirrored(hit.direction, s.normal), select(s.sphere, normalize(bent), hit.direction));
    rays.weight = weight;
    rays.medium = select(and_not(total, s.sphere), index, medium);
    rays.mirror = Int(-1);
    return rays;
}

// Appends to the queue. They start s.offset off the surface, on the side to which they go.
HWY_INLINE void enqueue(const SpawnedRays& rays, const SurfaceLanes& s, Real length, Int pixel, RayQueue& queue) {
    const int at = queue.size;
    const Real side = copy_sign(s.offset, dot(rays.direction, s.geometric_normal));
    const Vec3 origin = mul_add(s.geometric_normal, side, s.position);
    compress_store(origin.x, rays.active, queue.origin[0] + at);
    compress_store(origin.y, rays.active, queue.origin[1] + at);
    compress_store(origin.z, rays.active, queue.origin[2] + at);
    compress_store(rays.direction.x, rays.active, queue.direction[0] + at);
    compress_store(rays.direction.y, rays.active, queue.direction[1] + at);
    compress_store(rays.direction.z, rays.active, queue.direction[2] + at);
    compress_store(length, rays.active, queue.length + at);
    compress_store(rays.weight, rays.active, queue.weight + at);
    compress_store(rays.medium, rays.active, queue.medium + at);
    compress_store(pixel, rays.active, queue.pixel + at);
    compress_store(rays.mirror, rays.active, queue.mirror + at);
    queue.size += std::popcount(bits(rays.active));
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
