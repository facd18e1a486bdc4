#include "tracer/compiled/bvh_binning.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>

#include "tracer/compiled/leaf_blocks.h"
#include "tracer/ground/task_errors.h"

namespace raywalk::bvh {

namespace {

constexpr int bin_count = 16;
constexpr std::uint32_t leaf_shapes = block_width;
constexpr std::uint32_t task_shapes = 2048;         // smaller ranges are built by the thread that has them
constexpr std::uint32_t chunk_shapes = 16384;       // binned by one task
constexpr std::uint32_t deepest_binary_level = 58;  // from here on ranges are halved

// Lanes x, y, z; the fourth carries an index or nothing and is never looked at.
struct Box {
    __m128 lower = _mm_set1_ps(std::numeric_limits<float>::infinity());
    __m128 upper = _mm_set1_ps(-std::numeric_limits<float>::infinity());
    void extend(__m128 low, __m128 high) {
        lower = _mm_min_ps(lower, low);
        upper = _mm_max_ps(upper, high);
    }
    void extend(const Box& other) { extend(other.lower, other.upper); }
    [[nodiscard]] Bounds bounds() const {
        alignas(16) float low[4], high[4];
        _mm_store_ps(low, lower);
        _mm_store_ps(high, upper);
        return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    }
};

// Boxes of a range's primitives and of their centroids.
struct Extent {
    Box box, centroids;
    void extend(__m128 low, __m128 high, __m128 center) {
        box.extend(low, high);
        centroids.extend(center, center);
    }
    void extend(const Extent& other) {
        box.extend(other.box);
        centroids.extend(other.centroids);
    }
};

__m128 lower_of(const Primitive& p) { return _mm_load_ps(p.lower); }
__m128 upper_of(const Primitive& p) { return _mm_load_ps(p.upper); }
// Halved first: the sum of two large coordinates would overflow.
__m128 centroid(__m128 low, __m128 high) {
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

// Tests come in blocks, whose cost begins to count at a few lanes.
float cost_in_blocks(std::uint32_t shapes) { return static_cast<float>((shapes + 3) / 4); }

Plane cheapest(const Bins& bins, const Box& whole) {
    const RelativeArea area(whole);
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<float, bin_count> upper_cost{};
        Box box;
        std::uint32_t count = 0;
        for (int i = bin_count - 1; i > 0; --i) {
            box.extend(bins.box[axis][i]);
            count += bins.count[axis][i];
            upper_cost[i] = count == 0 ? -1 : area.of(box) * cost_in_blocks(count);
        }
        box = {};
        count = 0;
        for (int i = 1; i < bin_count; ++i) {
            box.extend(bins.box[axis][i - 1]);
            count += bins.count[axis][i - 1];
            if (count == 0 || upper_cost[i] < 0) continue;
            const float cost = area.of(box) * cost_in_blocks(count) + upper_cost[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }
    return best;
}

class Builder {
  public:
    explicit Builder(BinaryTree& tree) : tree_(tree), primitives_(tree.primitives.data()) {}

    void build() {
        const auto count = static_cast<std::uint32_t>(tree_.primitives.size());
        const Extent extent = extent_of(0, count);
        tree_.root = {0, count, 0, extent.box.bounds()};
        grow(tree_.root, extent, 0);
        tree_.binned = binned_;
    }

  private:
    [[nodiscard]] Extent extent_of(std::uint32_t begin, std::uint32_t end) const {
        Extent extent;
        for (std::uint32_t i = begin; i < end; ++i) {
            const __m128 low = lower_of(primitives_[i]), high = upper_of(primitives_[i]);
            extent.extend(low, high, centroid(low, high));
        }
        return extent;
    }

    // Splits a range until every part is a leaf.
    void grow(Range& range, const Extent& extent, std::uint32_t depth);
    // Moves what lies below the plane to the front; returns where the rest begins.
    std::uint32_t partition(const Range& range, const Grid& grid, const Plane& plane, Extent& lower, Extent& upper);
    [[nodiscard]] Bins bins_of(const Range& range, const Grid& grid) const;

    BinaryTree& tree_;
    Primitive* primitives_;
    std::atomic<std::uint64_t> binned_{0};
};

Bins Builder::bins_of(const Range& range, const Grid& grid) const {
    Bins bins;
    if (range.size() < 2 * chunk_shapes) {
        bins.add(primitives_ + range.begin, primitives_ + range.end, grid);
        return bins;
    }
    const std::uint32_t chunks = (range.size() + chunk_shapes - 1) / chunk_shapes;
    AlignedVector<Bins> parts(chunks);
    for (std::uint32_t c = 0; c < chunks; ++c) {
#pragma omp task shared(parts, grid, range) firstprivate(c)
        parts[c].add(primitives_ + range.begin + c * chunk_shapes,
                     primitives_ + std::min(range.begin + (c + 1) * chunk_shapes, range.end), grid);
    }
#pragma omp taskwait
    for (const Bins& part : parts) bins.add(part);
    return bins;
}

std::uint32_t Builder::partition(const Range& range, const Grid& grid, const Plane& plane, Extent& lower,
                                 Extent& upper) {
    const auto below = [&](__m128 center) {
        alignas(16) std::int32_t bin[4];
        _mm_store_si128(reinterpret_cast<__m128i*>(bin), grid.bins(center));
        return bin[plane.axis] < plane.bin;
    };
    Primitive* left = primitives_ + range.begin;
    Primitive* right = primitives_ + range.end;  // one past the last not yet known
    while (left < right) {
        const __m128 low = lower_of(*left), high = upper_of(*left), center = centroid(low, high);
        if (below(center)) {
            lower.extend(low, high, center);
            ++left;
        } else {
            upper.extend(low, high, center);
            --right;
            const __m128 swap_low = lower_of(*right), swap_high = upper_of(*right);
            _mm_store_ps(right->lower, low);
            _mm_store_ps(right->upper, high);
            _mm_store_ps(left->lower, swap_low);
            _mm_store_ps(left->upper, swap_high);
        }
    }
    return static_cast<std::uint32_t>(left - primitives_);
}

void Builder::grow(Range& range, const Extent& extent, std::uint32_t depth) {
    if (range.size() <= leaf_shapes) return;
    Extent lower, upper;
    const Grid grid(extent.centroids);
    Plane plane;
    if (depth + std::bit_width(range.size()) < deepest_binary_level) plane = cheapest(bins_of(range, grid), extent.box);
    if (plane.axis >= 0) {
        range.middle = partition(range, grid, plane, lower, upper);
    } else {
        // Centroids that no bin tells apart, or a chain too deep.
        if (range.size() <= largest_leaf) return;
        range.middle = range.begin + range.size() / 2;
        lower = extent_of(range.begin, range.middle);
        upper = extent_of(range.middle, range.end);
    }
    binned_.fetch_add(range.size(), std::memory_order_relaxed);
    Halves& halves = tree_.split_at[range.middle];
    halves.lower = {range.begin, range.middle, 0, lower.box.bounds()};
    halves.upper = {range.middle, range.end, 0, upper.box.bounds()};
    if (range.size() < task_shapes) {
        grow(halves.lower, lower, depth + 1);
        grow(halves.upper, upper, depth + 1);
        return;
    }
#pragma omp task shared(halves, lower) firstprivate(depth)
    grow(halves.lower, lower, depth + 1);
    grow(halves.upper, upper, depth + 1);
#pragma omp taskwait
}

}  // namespace

BinaryTree build_binary(AlignedVector<Primitive> primitives) {
    BinaryTree tree;
    tree.primitives = std::move(primitives);
    tree.split_at.resize(tree.primitives.size());
    Builder builder(tree);
#pragma omp parallel
#pragma omp single
    builder.build();
    return tree;
}

}  // namespace raywalk::bvh
