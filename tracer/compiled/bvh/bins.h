// The parts of a binned split: boxes in registers, bins over the centroids, and the cheapest plane between two bins.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>

#include "tracer/compiled/bvh/binning.h"
#include "tracer/compiled/leaf_blocks.h"

namespace raywalk::bvh {

inline constexpr int bin_count = 16;

// Lanes x, y, z; the fourth carries an index or nothing and is never looked at.
struct Box {
    __m128 lower = _mm_set1_ps(std::numeric_limits<float>::infinity());
    __m128 upper = _mm_set1_ps(-std::numeric_limits<float>::infinity());
    // A NaN extends nothing: minimum and maximum are their second operand where one is NaN.
    void extend(__m128 low, __m128 high) {
        lower = _mm_min_ps(low, lower);
        upper = _mm_max_ps(high, upper);
    }
    void extend(__m128 point) { extend(point, point); }
    void extend(const Box& other) { extend(other.lower, other.upper); }
    void store(float low[3], float high[3]) const {
        alignas(16) float four[4];
        _mm_store_ps(four, lower);
        std::copy(four, four + 3, low);
        _mm_store_ps(four, upper);
        std::copy(four, four + 3, high);
    }
    [[nodiscard]] Bounds bounds() const {
        float low[3], high[3];
        store(low, high);
        return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    }
};

// Boxes of a range's primitives and of their centroids.
struct Extent {
    Box box, centroids;
    void extend(__m128 low, __m128 high, __m128 center) {
        box.extend(low, high);
        centroids.extend(center);
    }
    void extend(const Extent& other) {
        box.extend(other.box);
        centroids.extend(other.centroids);
    }
};

inline __m128 lower_of(const Primitive& p) { return _mm_load_ps(p.lower); }
inline __m128 upper_of(const Primitive& p) { return _mm_load_ps(p.upper); }
inline void store(Primitive& p, __m128 low, __m128 high) {
    _mm_store_ps(p.lower, low);
    _mm_store_ps(p.upper, high);
}
// Halved first: the sum of two large coordinates would overflow.
inline __m128 centroid(__m128 low, __m128 high) {
    const __m128 half = _mm_set1_ps(0.5f);
    return _mm_add_ps(_mm_mul_ps(low, half), _mm_mul_ps(high, half));
}

// Maps centroids to bins. An axis on which they coincide has scale 0, so that all fall into bin 0.
struct Grid {
    __m128 origin, scale;

    explicit Grid(const Box& centroids) : origin(centroids.lower) {
        alignas(16) float size[4], factor[4] = {};
        _mm_store_ps(size, _mm_sub_ps(centroids.upper, centroids.lower));
        for (int axis = 0; axis < 3; ++axis) {
            const float f = 0.99f * bin_count / size[axis];  // infinite or tiny sizes cannot be divided into bins
            factor[axis] = std::isfinite(f) && f >= FLT_MIN ? f : 0;
        }
        scale = _mm_load_ps(factor);
    }
    [[nodiscard]] __m128i bins(__m128 center) const {
        return _mm_cvttps_epi32(_mm_mul_ps(_mm_sub_ps(center, origin), scale));
    }
};

struct Bins {
    Box box[3][bin_count];
    std::uint32_t count[3][bin_count] = {};

    void add(const Primitive* begin, const Primitive* end, const Grid& grid) {
        for (const Primitive* p = begin; p != end; ++p) {
            const __m128 low = lower_of(*p), high = upper_of(*p);
            alignas(16) std::int32_t bin[4];
            _mm_store_si128(reinterpret_cast<__m128i*>(bin), grid.bins(centroid(low, high)));
            for (int axis = 0; axis < 3; ++axis) {
                box[axis][bin[axis]].extend(low, high);
                ++count[axis][bin[axis]];
            }
        }
    }
    void add(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < bin_count; ++i) {
                box[axis][i].extend(other.box[axis][i]);
                count[axis][i] += other.count[axis][i];
            }
    }
};

struct Plane {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    int bin = 0;  // the first of the upper side
};

// Half areas of boxes inside a range's box, relative to its longest side squared: neither huge nor tiny coordinates
// leave the range of a float.
class RelativeArea {
  public:
    explicit RelativeArea(const Box& whole) {
        const glm::vec3 size = whole.bounds().upper * 0.5f - whole.bounds().lower * 0.5f;
        const float longest = std::max({size.x, size.y, size.z});
        scale_ = _mm_set1_ps(longest > FLT_MIN * 4 ? 1 / longest : 0);
    }
    [[nodiscard]] float of(const Box& box) const {
        const __m128 d = _mm_sub_ps(_mm_mul_ps(box.upper, scale_), _mm_mul_ps(box.lower, scale_));
        const __m128 turned = _mm_shuffle_ps(d, d, _MM_SHUFFLE(3, 0, 2, 1));
        alignas(16) float product[4];
        _mm_store_ps(product, _mm_mul_ps(d, turned));
        return product[0] + product[1] + product[2];
    }

  private:
    __m128 scale_;
};

inline Plane cheapest(const Bins& bins, const Box& whole) {
    const RelativeArea area(whole);
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<float, bin_count> upper_cost{};
        Box box;
        std::uint32_t count = 0;
        for (int i = bin_count - 1; i > 0; --i) {
            box.extend(bins.box[axis][i]);
            count += bins.count[axis][i];
            upper_cost[i] = count == 0 ? -1 : area.of(box) * static_cast<float>(leaf_cost(count));
        }
        box = {};
        count = 0;
        for (int i = 1; i < bin_count; ++i) {
            box.extend(bins.box[axis][i - 1]);
            count += bins.count[axis][i - 1];
            if (count == 0 || upper_cost[i] < 0) continue;
            const float cost = area.of(box) * static_cast<float>(leaf_cost(count)) + upper_cost[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }
    return best;
}

// Tells which side of a plane a centroid's bin is on.
class SideTest {
  public:
    SideTest(const Grid& grid, const Plane& plane)
        : grid_(grid), axis_(plane.axis), limit_(_mm_set1_epi32(plane.bin)) {}
    // All bits of all lanes set where the bin is below the plane.
    [[nodiscard]] __m128 below(__m128 center) const {
        const __m128i lanes = _mm_cmplt_epi32(grid_.bins(center), limit_);
        return _mm_castsi128_ps(axis_ == 0   ? _mm_shuffle_epi32(lanes, 0x00)
                                : axis_ == 1 ? _mm_shuffle_epi32(lanes, 0x55)
                                             : _mm_shuffle_epi32(lanes, 0xaa));
    }

  private:
    const Grid& grid_;
    int axis_;
    __m128i limit_;
};

// Boxes of the centroids on either side of a plane, extended without a branch: the minimum with a first operand of all
// bits set, a NaN, is its second operand.
struct CentroidSides {
    Box lower, upper;
    void extend(__m128 center, __m128 is_below) {
        const __m128 not_below = _mm_xor_ps(is_below, _mm_castsi128_ps(_mm_set1_epi32(-1)));
        lower.extend(_mm_or_ps(center, not_below));
        upper.extend(_mm_or_ps(center, is_below));
    }
    void extend(const CentroidSides& other) {
        lower.extend(other.lower);
        upper.extend(other.upper);
    }
};

}  // namespace raywalk::bvh
