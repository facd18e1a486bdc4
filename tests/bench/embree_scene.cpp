#include "tests/bench/embree_scene.h"

#include <immintrin.h>

#include <atomic>
#include <cstring>
#include <stdexcept>

#include "tests/bench/embree_spheres.h"

namespace raywalk::bench {

namespace {

constexpr unsigned triangle_geometry = 0, sphere_geometry = 1;

// Embree's monitor has no way to be asked: it calls, with the device as its user pointer's owner.
std::atomic<std::ptrdiff_t> bytes_now{0};

bool count_bytes(void*, ssize_t bytes, bool) {
    bytes_now += bytes;
    return true;
}

void attach_triangles(RTCDevice device, RTCScene scene, const Geometry& geometry, RTCBuildQuality quality) {
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                              geometry.positions.size());
    std::memcpy(positions, geometry.positions.data(), geometry.positions.size() * sizeof(glm::vec3));
    void* faces = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof geometry.faces[0],
                                          geometry.faces.size());
    std::memcpy(faces, geometry.faces.data(), geometry.faces.size() * sizeof geometry.faces[0]);
    rtcSetGeometryBuildQuality(g, quality);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene, g, triangle_geometry);
    rtcReleaseGeometry(g);
}

void attach_spheres(RTCDevice device, RTCScene scene, const std::vector<SphereShape>& spheres,
                    const EmbreeBuild& build) {
    RTCGeometry g = nullptr;
    if (build.spheres == EmbreeSpheres::callback) {
        g = make_sphere_geometry(device, spheres);
    } else {
        g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                                   4 * sizeof(float), spheres.size()));
        for (const SphereShape& s : spheres)
            for (const float value : {s.center.x, s.center.y, s.center.z, s.radius}) *points++ = value;
    }
    rtcSetGeometryBuildQuality(g, build.quality);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(scene, g, sphere_geometry);
    rtcReleaseGeometry(g);
}

// What stays the same from packet to packet.
template <int width>
void prepare(const RayBlocks& rays, RTCRayNt<width>& packet) {
    for (int i = 0; i < width; ++i) {
        packet.org_x[i] = rays.origin(0, 0);
        packet.org_y[i] = rays.origin(1, 0);
        packet.org_z[i] = rays.origin(2, 0);
        packet.time[i] = 0;
        packet.mask[i] = ~0u;
        packet.flags[i] = 0;
    }
}

// Lanes [lane, lane + width) of a block; returns whether any is to be traced.
template <int width>
bool fill(const RayPacket& block, bool common_origin, std::size_t lane, RTCRayNt<width>& packet, int* valid) {
    int any = 0;
    for (std::size_t i = 0; i < width; ++i) {
        valid[i] = block.t_max[lane + i] > block.t_min[lane + i] ? -1 : 0;
        any |= valid[i];
    }
    if (any == 0) return false;
    const auto copy = [lane](const float(&from)[packet_size], float* to) {
        std::memcpy(to, from + lane, width * sizeof(float));
    };
    if (!common_origin) {
        copy(block.origin[0], packet.org_x);
        copy(block.origin[1], packet.org_y);
        copy(block.origin[2], packet.org_z);
    }
    copy(block.direction[0], packet.dir_x);
    copy(block.direction[1], packet.dir_y);
    copy(block.direction[2], packet.dir_z);
    copy(block.t_min, packet.tnear);
    copy(block.t_max, packet.tfar);
    return true;
}

std::int32_t shape_id(unsigned geometry, unsigned primitive, std::int32_t triangle_count) {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return -1;
    return static_cast<std::int32_t>(primitive) + (geometry == sphere_geometry ? triangle_count : 0);
}

RTCIntersectContext context_of(EmbreeCall call) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = call.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

template <int width>
void intersect_packets(RTCScene scene, std::int32_t triangle_count, EmbreeCall call, const RayBlocks& rays,
                       HitBlocks& hits) {
    RTCIntersectContext context = context_of(call);
    alignas(64) RTCRayHitNt<width> packet;
    alignas(64) int valid[width];
    prepare<width>(rays, packet.ray);
    for (std::size_t first = 0; first < rays.size(); first += width) {
        const std::size_t lane = first % packet_size;
        if (lane == 0) fetch_ahead(rays, hits, first / packet_size);
        if (!fill<width>(rays.blocks()[first / packet_size], call.common_origin, lane, packet.ray, valid)) continue;
        for (int i = 0; i < width; ++i) packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        if constexpr (width == 8)
            rtcIntersect8(valid, scene, &context, reinterpret_cast<RTCRayHit8*>(&packet));
        else
            rtcIntersect16(valid, scene, &context, reinterpret_cast<RTCRayHit16*>(&packet));
        HitPacket& found = hits.blocks()[first / packet_size];
        std::memcpy(found.t + lane, packet.ray.tfar, sizeof packet.ray.tfar);
        std::memcpy(found.u + lane, packet.hit.u, sizeof packet.hit.u);
        std::memcpy(found.v + lane, packet.hit.v, sizeof packet.hit.v);
        for (std::size_t i = 0; i < width; ++i)
            found.id[lane + i] = shape_id(packet.hit.geomID[i], packet.hit.primID[i], triangle_count);
    }
}

template <int width>
void occlude_packets(RTCScene scene, EmbreeCall call, const RayBlocks& rays, HitBlocks& hits) {
    RTCIntersectContext context = context_of(call);
    alignas(64) RTCRayNt<width> packet;
    alignas(64) int valid[width];
    prepare<width>(rays, packet);
    for (std::size_t first = 0; first < rays.size(); first += width) {
        const std::size_t lane = first % packet_size;
        if (lane == 0) fetch_ahead(rays, hits, first / packet_size);
        if (!fill<width>(rays.blocks()[first / packet_size], call.common_origin, lane, packet, valid)) continue;
        if constexpr (width == 8)
            rtcOccluded8(valid, scene, &context, reinterpret_cast<RTCRay8*>(&packet));
        else
            rtcOccluded16(valid, scene, &context, reinterpret_cast<RTCRay16*>(&packet));
        HitPacket& found = hits.blocks()[first / packet_size];
        for (std::size_t i = 0; i < width; ++i) found.id[lane + i] = packet.tfar[i] < 0 ? 0 : -1;
    }
}

RTCRay single_ray(const RayBlocks& rays, std::size_t i) {
    return {rays.origin(0, i),
            rays.origin(1, i),
            rays.origin(2, i),
            rays.t_min(i),
            rays.direction(0, i),
            rays.direction(1, i),
            rays.direction(2, i),
            0,
            rays.t_max(i),
            ~0u,
            0,
            0};
}

}  // namespace

FlushDenormals::FlushDenormals() : before_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x40);  // denormals are zero
}
FlushDenormals::~FlushDenormals() { _mm_setcsr(before_); }

EmbreeDevice::EmbreeDevice(int threads)
    : device_(
          rtcNewDevice(("threads=" + std::to_string(threads) + ",user_threads=0,frequency_level=simd512").c_str())) {
    if (device_ == nullptr) throw std::runtime_error("Embree has no device");
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, nullptr);
}
EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }
std::ptrdiff_t EmbreeDevice::bytes() const { return bytes_now; }

EmbreeScene::EmbreeScene(const EmbreeDevice& device, const Geometry& geometry, const EmbreeBuild& build, Clock clock)
    : scene_(rtcNewScene(device.handle())), build_(build), spheres_(geometry.spheres) {
    rtcSetSceneBuildQuality(scene_, build.quality);
    if (!geometry.faces.empty()) attach_triangles(device.handle(), scene_, geometry, build.quality);
    if (!spheres_.empty()) attach_spheres(device.handle(), scene_, spheres_, build);
    const std::ptrdiff_t before = device.bytes();
    const double start = seconds(clock);
    rtcCommitScene(scene_);
    build_seconds_ = seconds(clock) - start;
    bytes_ = device.bytes() - before;
    if (const RTCError error = rtcGetDeviceError(device.handle()); error != RTC_ERROR_NONE)
        throw std::runtime_error("Embree failed to build (error " + std::to_string(error) + ")");
}
EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

std::vector<EmbreeCall> embree_calls() { return {{1, false}, {8, false}, {8, true}, {16, false}, {16, true}}; }

std::string to_string(const EmbreeBuild& build, bool has_spheres) {
    std::string text = build.quality == RTC_BUILD_QUALITY_LOW      ? "LOW"
                       : build.quality == RTC_BUILD_QUALITY_MEDIUM ? "MEDIUM"
                                                                   : "HIGH";
    if (has_spheres) text += build.spheres == EmbreeSpheres::callback ? ", callback" : ", SPHERE_POINT";
    return text;
}

std::string to_string(const EmbreeCall& call, bool any_hit) {
    return std::string(any_hit ? "Occluded" : "Intersect") + std::to_string(call.width) +
           (call.width == 1 ? ""
            : call.coherent ? " coherent"
                            : " incoherent");
}

void intersect(RTCScene scene, std::int32_t triangle_count, EmbreeCall call, const RayBlocks& rays, HitBlocks& hits) {
    const FlushDenormals flush;
    if (call.width == 8) return intersect_packets<8>(scene, triangle_count, call, rays, hits);
    if (call.width == 16) return intersect_packets<16>(scene, triangle_count, call, rays, hits);
    RTCIntersectContext context = context_of(call);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (i % packet_size == 0) fetch_ahead(rays, hits, i / packet_size);
        if (!(rays.t_max(i) > rays.t_min(i))) continue;
        RTCRayHit one;
        one.ray = single_ray(rays, i);
        one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &one);
        hits.set(i, {one.ray.tfar, one.hit.u, one.hit.v, shape_id(one.hit.geomID, one.hit.primID, triangle_count)});
    }
}

void occluded(RTCScene scene, EmbreeCall call, const RayBlocks& rays, HitBlocks& hits) {
    const FlushDenormals flush;
    if (call.width == 8) return occlude_packets<8>(scene, call, rays, hits);
    if (call.width == 16) return occlude_packets<16>(scene, call, rays, hits);
    RTCIntersectContext context = context_of(call);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (i % packet_size == 0) fetch_ahead(rays, hits, i / packet_size);
        if (!(rays.t_max(i) > rays.t_min(i))) continue;
        RTCRay ray = single_ray(rays, i);
        rtcOccluded1(scene, &context, &ray);
        hits.blocks()[i / packet_size].id[i % packet_size] = ray.tfar < 0 ? 0 : -1;
    }
}

}  // namespace raywalk::bench
