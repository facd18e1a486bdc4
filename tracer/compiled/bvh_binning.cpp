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
        errors_.guard([&] { tree_.root.middle = grow(0, count, extent, 0); });
        tree_.binned = binned_;
    }
    void rethrow() const { errors_.rethrow(); }

  private:
    [[nodiscard]] Extent extent_of(std::uint32_t begin, std::uint32_t end) const {
        Extent extent;
        for (std::uint32_t i = begin; i < end; ++i) {
            const __m128 low = lower_of(primitives_[i]), high = upper_of(primitives_[i]);
            extent.extend(low, high, centroid(low, high));
        }
        return extent;
    }

    // Splits the range until every part is a leaf; returns its middle, 0 where it is a leaf itself.
    std::uint32_t grow(std::uint32_t begin, std::uint32_t end, const Extent& extent, std::uint32_t depth);
    // Moves what lies below the plane to the front; returns where the rest begins, and the boxes of the centroids.
    std::uint32_t partition(std::uint32_t begin, std::uint32_t end, const Grid& grid, const Plane& plane,
                            Box& lower_centroids, Box& upper_centroids);
    [[nodiscard]] Bins bins_of(std::uint32_t begin, std::uint32_t end, const Grid& grid) const;

    BinaryTree& tree_;
    Primitive* primitives_;
    std::atomic<std::uint64_t> binned_{0};
    TaskErrors errors_;
};

Bins Builder::bins_of(std::uint32_t begin, std::uint32_t end, const Grid& grid) const {
    Bins bins;
    if (end - begin < 2 * chunk_shapes) {
        bins.add(primitives_ + begin, primitives_ + end, grid);
        return bins;
    }
    AlignedVector<Bins> parts((end - begin + chunk_shapes - 1) / chunk_shapes);
    for (std::uint32_t c = 0; c < parts.size(); ++c) {
#pragma omp task shared(parts, grid) firstprivate(begin, end, c)
        parts[c].add(primitives_ + begin + c * chunk_shapes,
                     primitives_ + std::min(begin + (c + 1) * chunk_shapes, end), grid);
    }
#pragma omp taskwait
    for (const Bins& part : parts) bins.add(part);
    return bins;
}

std::uint32_t Builder::partition(std::uint32_t begin, std::uint32_t end, const Grid& grid, const Plane& plane,
                                 Box& lower_centroids, Box& upper_centroids) {
    // Without a branch that could be mispredicted: every primitive changes places with the first of the upper side,
    // and the side grows or not. The other side's minimum sees NaN (all bits set) as its first operand and keeps its
    // second.
    alignas(16) std::int32_t first_upper[4];
    std::fill(std::begin(first_upper), std::end(first_upper), plane.bin);
    const __m128i limit = _mm_load_si128(reinterpret_cast<const __m128i*>(first_upper));
    Primitive* upper = primitives_ + begin;
    Box below_box, above_box;
    for (Primitive* p = upper; p != primitives_ + end; ++p) {
        const __m128 low = lower_of(*p), high = upper_of(*p), center = centroid(low, high);
        const __m128i below = _mm_cmplt_epi32(grid.bins(center), limit);
        const __m128 is_below = _mm_castsi128_ps(plane.axis == 0   ? _mm_shuffle_epi32(below, 0x00)
                                                 : plane.axis == 1 ? _mm_shuffle_epi32(below, 0x55)
                                                                   : _mm_shuffle_epi32(below, 0xaa));
        const __m128 not_above = is_below, not_below = _mm_xor_ps(is_below, _mm_castsi128_ps(_mm_set1_epi32(-1)));
        const __m128 center_below = _mm_or_ps(center, not_below), center_above = _mm_or_ps(center, not_above);
        below_box.lower = _mm_min_ps(center_below, below_box.lower);
        below_box.upper = _mm_max_ps(center_below, below_box.upper);
        above_box.lower = _mm_min_ps(center_above, above_box.lower);
        above_box.upper = _mm_max_ps(center_above, above_box.upper);
        _mm_store_ps(p->lower, lower_of(*upper));
        _mm_store_ps(p->upper, upper_of(*upper));
        _mm_store_ps(upper->lower, low);
        _mm_store_ps(upper->upper, high);
        upper += _mm_movemask_ps(is_below) & 1;
    }
    lower_centroids = below_box;
    upper_centroids = above_box;
    return static_cast<std::uint32_t>(upper - primitives_);
}

std::uint32_t Builder::grow(std::uint32_t begin, std::uint32_t end, const Extent& extent, std::uint32_t depth) {
    const std::uint32_t size = end - begin;
    if (size <= leaf_shapes) return 0;
    Extent lower, upper;
    Plane plane;
    std::uint32_t middle = 0;
    if (depth + std::bit_width(size) < deepest_binary_level) {
        const Grid grid(extent.centroids);
        const Bins bins = bins_of(begin, end, grid);
        plane = cheapest(bins, extent.box);
        if (plane.axis >= 0) {
            for (int i = 0; i < bin_count; ++i) (i < plane.bin ? lower : upper).box.extend(bins.box[plane.axis][i]);
            middle = partition(begin, end, grid, plane, lower.centroids, upper.centroids);
        }
    }
    if (middle == 0) {
        // Centroids that no bin tells apart, or a chain too deep.
        if (size <= largest_leaf) return 0;
        middle = begin + size / 2;
        lower = extent_of(begin, middle);
        upper = extent_of(middle, end);
    }
    binned_.fetch_add(size, std::memory_order_relaxed);
    Halves& halves = tree_.split_at[middle];
    lower.box.store(halves.lower[0], halves.upper[0]);
    upper.box.store(halves.lower[1], halves.upper[1]);
    if (size < task_shapes) {
        halves.middle[0] = grow(begin, middle, lower, depth + 1);
        halves.middle[1] = grow(middle, end, upper, depth + 1);
        return middle;
    }
#pragma omp task shared(halves, lower) firstprivate(begin, middle, depth)
    errors_.guard([&] { halves.middle[0] = grow(begin, middle, lower, depth + 1); });
    // No exception may leave before the task is done with `lower`.
    errors_.guard([&] { halves.middle[1] = grow(middle, end, upper, depth + 1); });
#pragma omp taskwait
    return middle;
}

}  // namespace

BinaryTree build_binary(AlignedVector<Primitive> primitives) {
    BinaryTree tree;
    tree.primitives = std::move(primitives);
    tree.split_at = std::make_unique_for_overwrite<Halves[]>(tree.primitives.size());
    Builder builder(tree);
#pragma omp parallel
#pragma omp single
    builder.build();
    builder.rethrow();
    return tree;
}

}  // namespace raywalk::bvh
