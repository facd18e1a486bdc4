// The doors of intersect.h, asked of Embree: beams as coherent packets of sixteen, the rest ray by ray.
#include "tests/bench/kernels_on_embree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/kernels_on_embree.cpp"
#include "hwy/foreach_target.h"

#include "tracer/kernels/intersect.h"
#include "tracer/kernels/planes.h"

HWY_BEFORE_NAMESPACE();
namespace raywalk {
namespace HWY_NAMESPACE {
namespace {

RTCScene embree_of(const CompiledScene& scene) { return static_cast<const bench::SceneOnEmbree&>(scene).embree; }

RTCIntersectContext context_of(bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

std::int32_t shape_id(const CompiledScene& scene, unsigned geometry, unsigned primitive) {
    return static_cast<std::int32_t>(primitive) + (geometry == 0 ? 0 : scene.triangle_count);
}

// Rays [at, at + 16) of a beam; t is where the nearest plane lies.
void fill(const BeamRays& rays, int at, Real t, RTCRay16& packet) {
    store(Real(rays.origin[0]), packet.org_x);
    store(Real(rays.origin[1]), packet.org_y);
    store(Real(rays.origin[2]), packet.org_z);
    store(load(rays.direction[0] + at), packet.dir_x);
    store(load(rays.direction[1] + at), packet.dir_y);
    store(load(rays.direction[2] + at), packet.dir_z);
    store(load(rays.t_min + at), packet.tnear);
    store(t, packet.tfar);
    store(Real(0.0f), packet.time);
    store(Int(-1), reinterpret_cast<std::int32_t*>(packet.mask));
    store(Int(0), reinterpret_cast<std::int32_t*>(packet.flags));
}

Vec3 directions(const BeamRays& rays, int at) {
    return {load(rays.direction[0] + at), load(rays.direction[1] + at), load(rays.direction[2] + at)};
}

// -1 in the lanes to trace.
void set_valid(std::uint32_t active, std::int32_t* valid) {
    store(select(mask_of_bits(active), Int(-1), Int(0)), valid);
}

}  // namespace

void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, BeamHits& hits) {
    RTCIntersectContext context = context_of(true);
    for (int at = 0; at < beam_rays; at += lanes) {
        const auto own = static_cast<std::uint32_t>(active >> at) & 0xffffu;
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, rays.origin, directions(rays, at), load(rays.t_min + at), t, id);
        id = select(mask_of_bits(own), id, Int(-1));
        alignas(64) RTCRayHit16 packet;
        alignas(64) std::int32_t valid[lanes];
        fill(rays, at, t, packet.ray);
        store(Int(-1), reinterpret_cast<std::int32_t*>(packet.hit.geomID));
        set_valid(own, valid);
        if (own != 0) rtcIntersect16(valid, embree_of(scene), &context, &packet);
        const Int geometry = load(reinterpret_cast<const std::int32_t*>(packet.hit.geomID));
        const Mask found = mask_of_bits(own) & !(geometry == Int(-1));
        const Int shape = load(reinterpret_cast<const std::int32_t*>(packet.hit.primID)) +
                          select(geometry == Int(0), Int(0), Int(scene.triangle_count));
        store(select(found, load(packet.ray.tfar), t), hits.t + at);
        store(select(found, load(packet.hit.u), Real(0.0f)), hits.u + at);
        store(select(found, load(packet.hit.v), Real(0.0f)), hits.v + at);
        store(select(found, shape, id), hits.id + at);
    }
}

std::uint64_t occluded_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active) {
    RTCIntersectContext context = context_of(true);
    std::uint64_t blocked = 0;
    for (int at = 0; at < beam_rays; at += lanes) {
        auto own = static_cast<std::uint32_t>(active >> at) & 0xffffu;
        if (own == 0) continue;
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, rays.origin, directions(rays, at), load(rays.t_min + at), t, id);
        std::uint32_t met = bits(id > Int(-1)) & own;
        own &= ~met;
        if (own != 0) {
            alignas(64) RTCRay16 packet;
            alignas(64) std::int32_t valid[lanes];
            fill(rays, at, load(rays.t_max + at), packet);
            set_valid(own, valid);
            rtcOccluded16(valid, embree_of(scene), &context, &packet);
            met |= bits(load(packet.tfar) < Real(0.0f)) & own;
        }
        blocked |= static_cast<std::uint64_t>(met) << at;
    }
    return blocked;
}

RayHit intersect_ray(const CompiledScene& scene, const Ray& ray) {
    Real t = Real(ray.t_max);
    Int id = Int(-1);
    nearest_planes(scene, ray.origin, splat3(ray.direction), Real(ray.t_min), t, id);
    RTCIntersectContext context = context_of(false);
    RTCRayHit one;
    one.ray = {ray.origin[0],
               ray.origin[1],
               ray.origin[2],
               ray.t_min,
               ray.direction[0],
               ray.direction[1],
               ray.direction[2],
               0,
               lane(t, 0),
               ~0u,
               0,
               0};
    one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_of(scene), &context, &one);
    if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {lane(t, 0), 0, 0, lane(id, 0)};
    return {one.ray.tfar, one.hit.u, one.hit.v, shape_id(scene, one.hit.geomID, one.hit.primID)};
}

bool occluded_ray(const CompiledScene& scene, const Ray& ray) {
    Real t = Real(ray.t_max);
    Int id = Int(-1);
    nearest_planes(scene, ray.origin, splat3(ray.direction), Real(ray.t_min), t, id);
    if (lane(id, 0) >= 0) return true;
    RTCIntersectContext context = context_of(false);
    RTCRay one = {ray.origin[0],
                  ray.origin[1],
                  ray.origin[2],
                  ray.t_min,
                  ray.direction[0],
                  ray.direction[1],
                  ray.direction[2],
                  0,
                  ray.t_max,
                  ~0u,
                  0,
                  0};
    rtcOccluded1(embree_of(scene), &context, &one);
    return one.tfar < 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raywalk::bench {

const Kernels* kernels_on_embree(std::string_view name) { return select_kernels(name); }

}  // namespace raywalk::bench
#endif
