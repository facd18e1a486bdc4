// The same geometry in Embree, asked in every way that it offers.
#pragma once

#include <embree3/rtcore.h>

#include <string>
#include <vector>

#include "tests/bench/geometry.h"
#include "tests/bench/measure.h"
#include "tracer/kernels/kernels.h"

namespace raywalk::bench {

class EmbreeDevice {
  public:
    explicit EmbreeDevice(int threads);
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    [[nodiscard]] RTCDevice handle() const { return device_; }
    // That Embree holds now, as its memory monitor tells.
    [[nodiscard]] std::ptrdiff_t bytes() const;

  private:
    RTCDevice device_;
};

enum class EmbreeSpheres { callback, point };  // user geometry with our callback, or RTC_GEOMETRY_TYPE_SPHERE_POINT

struct EmbreeBuild {
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
    EmbreeSpheres spheres = EmbreeSpheres::callback;
    friend bool operator==(const EmbreeBuild&, const EmbreeBuild&) = default;
};

class EmbreeScene {
  public:
    // Builds at once. Shape ids are those of CompiledScene: triangles, then spheres.
    EmbreeScene(const EmbreeDevice& device, const Geometry& geometry, const EmbreeBuild& build,
                Clock clock = Clock::wall);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    [[nodiscard]] RTCScene handle() const { return scene_; }
    [[nodiscard]] const EmbreeBuild& build() const { return build_; }
    [[nodiscard]] double build_seconds() const { return build_seconds_; }  // of the commit alone
    [[nodiscard]] std::ptrdiff_t bytes() const { return bytes_; }          // of the hierarchy

  private:
    RTCScene scene_;
    EmbreeBuild build_;
    std::vector<SphereShape> spheres_;  // that the callback reads
    double build_seconds_ = 0;
    std::ptrdiff_t bytes_ = 0;
};

// One way of asking.
struct EmbreeCall {
    int width = 1;               // rtcIntersect1, 8 or 16; rtcOccluded1, 8 or 16
    bool coherent = false;       // the context's flag
    bool common_origin = false;  // of all rays: packets get it once
    friend bool operator==(const EmbreeCall&, const EmbreeCall&) = default;
};
std::vector<EmbreeCall> embree_calls();
std::string to_string(const EmbreeBuild& build, bool has_spheres);
std::string to_string(const EmbreeCall& call, bool any_hit);

// As kernels.h has them: rays with t_max <= t_min are left out. The number of rays is a multiple of 16.
// `triangle_count`: ids before the spheres'.
void intersect(RTCScene scene, std::int32_t triangle_count, EmbreeCall call, const RayBlocks& rays, HitBlocks& hits);
void occluded(RTCScene scene, EmbreeCall call, const RayBlocks& rays, HitBlocks& hits);

// Embree wants denormals flushed to zero while it traces, and says that all else may cost a lot.
class FlushDenormals {
  public:
    FlushDenormals();
    ~FlushDenormals();

  private:
    unsigned before_;
};

}  // namespace raywalk::bench
