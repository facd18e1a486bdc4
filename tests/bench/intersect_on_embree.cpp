// The doors of intersect.h, asked of Embree in packets of sixteen, those of beams coherent.
#include "tests/bench/kernels_on_embree.h"
#include "tracer/kernels/traversal/intersect.h"
#include "tracer/kernels/traversal/planes.h"

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

Vec3 origins(const BeamRays& rays, int) { return splat3(rays.origin); }
Vec3 origins(const RayPacket& rays, int at) {
    return {load(rays.origin[0] + at), load(rays.origin[1] + at), load(rays.origin[2] + at)};
}

template <class Rays>
Vec3 directions(const Rays& rays, int at) {
    return {load(rays.direction[0] + at), load(rays.direction[1] + at), load(rays.direction[2] + at)};
}

// Rays [at, at + 16); t is where the nearest plane lies.
template <class Rays>
void fill(const Rays& rays, int at, Real t, RTCRay16& packet) {
    const Vec3 origin = origins(rays, at), direction = directions(rays, at);
    store(origin.x, packet.org_x);
    store(origin.y, packet.org_y);
    store(origin.z, packet.org_z);
    store(direction.x, packet.dir_x);
    store(direction.y, packet.dir_y);
    store(direction.z, packet.dir_z);
    store(load(rays.t_min + at), packet.tnear);
    store(t, packet.tfar);
    store(Real(0.0f), packet.time);
    store(Int(-1), reinterpret_cast<std::int32_t*>(packet.mask));
    store(Int(0), reinterpret_cast<std::int32_t*>(packet.flags));
}

// -1 in the lanes to trace.
void set_valid(std::uint32_t active, std::int32_t* valid) {
    store(select(mask_of_bits(active), Int(-1), Int(0)), valid);
}

template <class Rays>
void intersect(const CompiledScene& scene, const Rays& rays, std::uint64_t active, bool coherent, HitPacket& hits) {
    RTCIntersectContext context = context_of(coherent);
    for (int at = 0; at < packet_size; at += lanes) {
        const auto own = static_cast<std::uint32_t>(active >> at) & 0xffffu;
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, origins(rays, at), directions(rays, at), load(rays.t_min + at), t, id);
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

template <class Rays>
std::uint64_t occluded(const CompiledScene& scene, const Rays& rays, std::uint64_t active, bool coherent) {
    RTCIntersectContext context = context_of(coherent);
    std::uint64_t blocked = 0;
    for (int at = 0; at < packet_size; at += lanes) {
        auto own = static_cast<std::uint32_t>(active >> at) & 0xffffu;
        if (own == 0) continue;
        Real t = load(rays.t_max + at);
        Int id = Int(-1);
        nearest_planes(scene, origins(rays, at), directions(rays, at), load(rays.t_min + at), t, id);
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

}  // namespace

void intersect_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, HitPacket& hits) {
    intersect(scene, rays, active, true, hits);
}
std::uint64_t occluded_beam(const CompiledScene& scene, const BeamRays& rays, std::uint64_t active, bool together) {
    return occluded(scene, rays, active, together);
}
void intersect_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active, HitPacket& hits) {
    intersect(scene, rays, active, false, hits);
}
std::uint64_t occluded_packet(const CompiledScene& scene, const RayPacket& rays, std::uint64_t active) {
    return occluded(scene, rays, active, false);
}

}  // namespace HWY_NAMESPACE
}  // namespace raywalk
HWY_AFTER_NAMESPACE();
