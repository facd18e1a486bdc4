#include "tracer/compiled/bvh/binning.h"

#include <atomic>
#include <bit>

#include "tracer/compiled/bvh/bins.h"
#include "tracer/ground/task_errors.h"

namespace raywalk::bvh {

namespace {

constexpr std::uint32_t leaf_shapes = lanes;
constexpr std::uint32_t task_shapes = 2048;         // smaller ranges are built by the thread that has them
constexpr std::uint32_t chunk_shapes = 8192;        // of a wide range: binned and moved by one task
constexpr std::uint32_t wide_shapes = 1u << 16;     // from here on several tasks work on one range
constexpr std::uint32_t deepest_binary_level = 58;  // from here on ranges are halved

// Calls work(i) for i in [0, count), each in a task of its own.
template <class Work>
void for_each_task(std::uint32_t count, const Work& work) {
    for (std::uint32_t i = 0; i < count; ++i) {
#pragma omp task shared(work) firstprivate(i)
        work(i);
    }
#pragma omp taskwait
}

class Builder {
  public:
    explicit Builder(BinaryTree& tree) : tree_(tree), primitives_(tree.primitives.shapes.get()) {
        // Wide ranges move to and fro between two arrays.
        if (tree.primitives.count >= wide_shapes)
            other_ = std::make_unique_for_overwrite<Primitive[]>(tree.primitives.count);
    }

    void build() {
        errors_.guard([&] {
            const std::uint32_t count = tree_.primitives.count;
            const Extent extent = wide_extent(count);
            tree_.root = {0, count, 0, extent.box.bounds()};
            tree_.root.middle = grow(0, count, extent, 0, primitives_);
        });
        tree_.binned = binned_;
    }
    void rethrow() const { errors_.rethrow(); }

  private:
    // What a split leaves on either side.
    struct Sides {
        Extent lower, upper;
        std::uint32_t middle = 0;  // 0: no plane splits the range
    };

    [[nodiscard]] static Extent extent_of(const Primitive* begin, const Primitive* end);
    [[nodiscard]] Extent wide_extent(std::uint32_t count) const;

    // Splits the range, which lies in `from`, until every part is a leaf and lies in primitives_; returns its middle,
    // 0 where it is a leaf itself.
    std::uint32_t grow(std::uint32_t begin, std::uint32_t end, const Extent& extent, std::uint32_t depth,
                       Primitive* from);
    static Sides split(std::uint32_t begin, std::uint32_t end, const Extent& extent, Primitive* in);
    // By several tasks, from one array to the other.
    static Sides split_wide(std::uint32_t begin, std::uint32_t end, const Extent& extent, const Primitive* from,
                            Primitive* to);

    BinaryTree& tree_;
    Primitive* primitives_;
    std::unique_ptr<Primitive[]> other_;
    std::atomic<std::uint64_t> binned_{0};
    TaskErrors errors_;
};

Extent Builder::extent_of(const Primitive* begin, const Primitive* end) {
    Extent extent;
    for (const Primitive* p = begin; p != end; ++p) {
        const __m128 low = lower_of(*p), high = upper_of(*p);
        extent.extend(low, high, centroid(low, high));
    }
    return extent;
}

Extent Builder::wide_extent(std::uint32_t count) const {
    AlignedVector<Extent> chunks((count + chunk_shapes - 1) / chunk_shapes);
    for_each_task(static_cast<std::uint32_t>(chunks.size()), [&](std::uint32_t c) {
        chunks[c] = extent_of(primitives_ + c * chunk_shapes, primitives_ + std::min((c + 1) * chunk_shapes, count));
    });
    Extent extent;
    for (const Extent& chunk : chunks) extent.extend(chunk);
    return extent;
}

void boxes_of_sides(const Bins& bins, const Plane& plane, Box& lower, Box& upper) {
    for (int i = 0; i < bin_count; ++i) (i < plane.bin ? lower : upper).extend(bins.box[plane.axis][i]);
}

Builder::Sides Builder::split(std::uint32_t begin, std::uint32_t end, const Extent& extent, Primitive* in) {
    Sides sides;
    const Grid grid(extent.centroids);
    Bins bins;
    bins.add(in + begin, in + end, grid);
    const Plane plane = cheapest(bins, extent.box);
    if (plane.axis < 0) return sides;
    boxes_of_sides(bins, plane, sides.lower.box, sides.upper.box);

    // Without a branch that could be mispredicted: every primitive changes places with the first of the upper side,
    // which moves on or not.
    const SideTest side(grid, plane);
    CentroidSides centroids;
    Primitive* upper = in + begin;
    for (Primitive* p = upper; p != in + end; ++p) {
        const __m128 low = lower_of(*p), high = upper_of(*p), center = centroid(low, high);
        const __m128 is_below = side.below(center);
        centroids.extend(center, is_below);
        store(*p, lower_of(*upper), upper_of(*upper));
        store(*upper, low, high);
        upper += _mm_movemask_ps(is_below) & 1;
    }
    sides.lower.centroids = centroids.lower;
    sides.upper.centroids = centroids.upper;
    sides.middle = static_cast<std::uint32_t>(upper - in);
    return sides;
}

Builder::Sides Builder::split_wide(std::uint32_t begin, std::uint32_t end, const Extent& extent, const Primitive* from,
                                   Primitive* to) {
    Sides sides;
    const Grid grid(extent.centroids);
    const std::uint32_t chunk_count = (end - begin + chunk_shapes - 1) / chunk_shapes;
    const auto chunk_begin = [&](std::uint32_t c) { return std::min(begin + c * chunk_shapes, end); };
    AlignedVector<Bins> chunk_bins(chunk_count);
    for_each_task(chunk_count,
                  [&](std::uint32_t c) { chunk_bins[c].add(from + chunk_begin(c), from + chunk_begin(c + 1), grid); });
    Bins bins;
    for (const Bins& of_chunk : chunk_bins) bins.add(of_chunk);
    const Plane plane = cheapest(bins, extent.box);
    if (plane.axis < 0) return sides;
    boxes_of_sides(bins, plane, sides.lower.box, sides.upper.box);

    // The bins tell how many of each chunk go where.
    std::vector<std::uint32_t> first_lower(chunk_count);
    sides.middle = begin;
    for (std::uint32_t c = 0; c < chunk_count; ++c) {
        first_lower[c] = sides.middle;
        for (int i = 0; i < plane.bin; ++i) sides.middle += chunk_bins[c].count[plane.axis][i];
    }
    const SideTest side(grid, plane);
    AlignedVector<CentroidSides> chunk_centroids(chunk_count);
    for_each_task(chunk_count, [&](std::uint32_t c) {
        CentroidSides centroids;
        Primitive* lower = to + first_lower[c];
        Primitive* upper = to + sides.middle + ((chunk_begin(c) - begin) - (first_lower[c] - begin));
        for (const Primitive *p = from + chunk_begin(c), *last = from + chunk_begin(c + 1); p != last; ++p) {
            const __m128 low = lower_of(*p), high = upper_of(*p), center = centroid(low, high);
            const __m128 is_below = side.below(center);
            centroids.extend(center, is_below);
            const int goes_below = _mm_movemask_ps(is_below) & 1;
            store(goes_below != 0 ? *lower : *upper, low, high);
            lower += goes_below;
            upper += 1 - goes_below;
        }
        chunk_centroids[c] = centroids;
    });
    CentroidSides centroids;
    for (const CentroidSides& of_chunk : chunk_centroids) centroids.extend(of_chunk);
    sides.lower.centroids = centroids.lower;
    sides.upper.centroids = centroids.upper;
    return sides;
}

std::uint32_t Builder::grow(std::uint32_t begin, std::uint32_t end, const Extent& extent, std::uint32_t depth,
                            Primitive* from) {
    const std::uint32_t size = end - begin;
    const bool wide = size >= wide_shapes;
    if (!wide && from != primitives_) {
        std::copy(from + begin, from + end, primitives_ + begin);
        from = primitives_;
    }
    if (size <= leaf_shapes) return 0;
    Sides sides;
    Primitive* to = from;
    if (depth + std::bit_width(size) < deepest_binary_level) {
        if (wide) to = from == primitives_ ? other_.get() : primitives_;
        sides = wide ? split_wide(begin, end, extent, from, to) : split(begin, end, extent, from);
    }
    if (sides.middle == 0) {
        // Centroids that no bin tells apart, or a chain too deep.
        if (size <= largest_leaf) return 0;
        to = from;
        sides.middle = begin + size / 2;
        sides.lower = extent_of(from + begin, from + sides.middle);
        sides.upper = extent_of(from + sides.middle, from + end);
    }
    binned_.fetch_add(size, std::memory_order_relaxed);
    const std::uint32_t middle = sides.middle;
    Halves& halves = tree_.split_at[middle];
    sides.lower.box.store(halves.lower[0], halves.upper[0]);
    sides.upper.box.store(halves.lower[1], halves.upper[1]);
    if (size < task_shapes) {
        halves.middle[0] = grow(begin, middle, sides.lower, depth + 1, to);
        halves.middle[1] = grow(middle, end, sides.upper, depth + 1, to);
        return middle;
    }
#pragma omp task shared(halves, sides) firstprivate(begin, middle, depth, to)
    errors_.guard([&] { halves.middle[0] = grow(begin, middle, sides.lower, depth + 1, to); });
    // No exception may leave before the task is done with `sides`.
    errors_.guard([&] { halves.middle[1] = grow(middle, end, sides.upper, depth + 1, to); });
#pragma omp taskwait
    return middle;
}

}  // namespace

BinaryTree build_binary(Primitives primitives) {
    BinaryTree tree;
    tree.primitives = std::move(primitives);
    tree.split_at = std::make_unique_for_overwrite<Halves[]>(tree.primitives.count);
    Builder builder(tree);
#pragma omp parallel
#pragma omp single
    builder.build();
    builder.rethrow();
    return tree;
}

}  // namespace raywalk::bvh
