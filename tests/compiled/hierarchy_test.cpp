// What both hierarchies promise about themselves: invariants, one result for any number of threads, growth, quality.
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstring>

#include "tests/oracle/compiled_shapes.h"
#include "tests/oracle/validate.h"
#include "tracer/compiled/hierarchy.h"
#include "tracer/compiled/shape_bounds.h"
#include "tracer/ground/sanitized.h"

namespace raywalk::testing {
namespace {

KdOptions with_leaf_limit(int limit) {
    KdOptions options;
    options.leaf_limit = limit;
    options.traversal_cost = 0.1f;
    return options;
}

class Invariants : public ::testing::TestWithParam<ShapeSet> {};

TEST_P(Invariants, HoldForTheKdTree) {
    const Shapes shapes = GetParam().shapes();
    EXPECT_EQ(validate(build_kd_tree(shapes, {}), shapes), "");
}
TEST_P(Invariants, HoldForKdTreesOfSmallLeaves) {
    const Shapes shapes = GetParam().shapes();
    for (const int limit : {0, 1, 4}) EXPECT_EQ(validate(build_kd_tree(shapes, with_leaf_limit(limit)), shapes), "");
}
TEST_P(Invariants, HoldForTheBvh) {
    const Shapes shapes = GetParam().shapes();
    EXPECT_EQ(validate(build_bvh(shapes), shapes), "");
}

INSTANTIATE_TEST_SUITE_P(Scenes, Invariants, ::testing::ValuesIn(awkward_scenes()),
                         [](const auto& scene) { return scene.param.name; });

// Large enough that every parallel phase runs (the BVH has one from 65,536 shapes on): a mesh among spheres.
ShapeSet large_scene() {
    ShapeSet scene{"large", bumpy_ball(190), {}};
    Random random(21);
    for (int i = 0; i < 6000; ++i) scene.spheres.push_back({random.point(-2, 2), random.between(0.001f, 0.05f)});
    return scene;
}

TEST(Hierarchies, OfALargeSceneKeepTheirInvariants) {
    const ShapeSet scene = large_scene();
    EXPECT_EQ(validate(build_kd_tree(scene.shapes(), {}), scene.shapes()), "");
    EXPECT_EQ(validate(build_bvh(scene.shapes()), scene.shapes()), "");
}

template <class T>
bool same_bits(const AlignedVector<T>& a, const AlignedVector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_bits(const Hierarchy& a, const Hierarchy& b) {
    if (!same_bits(a.triangle_blocks, b.triangle_blocks) || !same_bits(a.sphere_blocks, b.sphere_blocks)) return false;
    if (a.bounds != b.bounds || a.tree.index() != b.tree.index()) return false;
    if (const auto* kd = std::get_if<KdTree>(&a.tree)) {
        const auto& other = std::get<KdTree>(b.tree);
        return same_bits(kd->nodes, other.nodes) && same_bits(kd->leaves, other.leaves) && kd->depth == other.depth;
    }
    const auto &bvh = std::get<Bvh>(a.tree), &other = std::get<Bvh>(b.tree);
    return same_bits(bvh.nodes, other.nodes) && bvh.depth == other.depth;
}

class Threads : public ::testing::TestWithParam<int> {
  protected:
    void SetUp() override { omp_set_num_threads(GetParam()); }
    void TearDown() override { omp_set_num_threads(before_); }

  private:
    int before_ = omp_get_max_threads();
};

TEST_P(Threads, DoNotShowInTheKdTree) {
    const ShapeSet scene = large_scene();
    BuildStatistics statistics, alone;
    const Hierarchy many = build_kd_tree(scene.shapes(), {}, &statistics);
    omp_set_num_threads(1);
    EXPECT_TRUE(same_bits(many, build_kd_tree(scene.shapes(), {}, &alone)));
    EXPECT_EQ(statistics.events, alone.events);
    EXPECT_EQ(statistics.sah_cost, alone.sah_cost);
}
TEST_P(Threads, DoNotShowInTheBvh) {
    const ShapeSet scene = large_scene();
    BuildStatistics statistics, alone;
    const Hierarchy many = build_bvh(scene.shapes(), &statistics);
    omp_set_num_threads(1);
    EXPECT_TRUE(same_bits(many, build_bvh(scene.shapes(), &alone)));
    EXPECT_EQ(statistics.events, alone.events);
    EXPECT_EQ(statistics.sah_cost, alone.sah_cost);
}

const std::vector<int> numbers_of_threads = RAYWALK_SANITIZED ? std::vector{2, 7} : std::vector{1, 2, 3, 7, 16};
INSTANTIATE_TEST_SUITE_P(OfAnyNumber, Threads, ::testing::ValuesIn(numbers_of_threads));

// Events per triangle and level of the tree. A tree of N triangles has log2(N / 32) levels down to leaves of a block
// or two, so N log N work keeps the figure constant; what is left is the part of the straddling triangles, which
// shrinks with N. N log^2 N would triple it from 2,048 to a million triangles, N^1.5 would multiply it by 8.
TEST(KdTree, BuildWorkGrowsAsNLogN) {
    double smallest = 1e300, largest = 0;
    for (const int n : {32, 100, 320, 708}) {
        const auto triangles = bumpy_ball(n);
        BuildStatistics statistics;
        build_kd_tree({triangles, {}}, {}, &statistics);
        const auto count = static_cast<double>(triangles.size());
        const double per_level = static_cast<double>(statistics.events) / (count * std::log2(count / 32));
        smallest = std::min(smallest, per_level);
        largest = std::max(largest, per_level);
        EXPECT_GE(static_cast<double>(statistics.events), 12 * count) << "six events each, at least made and sorted";
        // Memory is linear: references grow with the surface, not with the tree.
        EXPECT_LE(static_cast<double>(statistics.references), 2.5 * count);
        EXPECT_LE(static_cast<double>(statistics.bytes), 200 * count);
    }
    EXPECT_LE(largest, 1.6 * smallest);
}

TEST(Bvh, BuildWorkGrowsAsNLogN) {
    double smallest = 1e300, largest = 0;
    for (const int n : {32, 100, 320, 708}) {
        const auto triangles = bumpy_ball(n);
        BuildStatistics statistics;
        build_bvh({triangles, {}}, &statistics);
        const auto count = static_cast<double>(triangles.size());
        const double per_level = static_cast<double>(statistics.events) / (count * std::log2(count / 16));
        smallest = std::min(smallest, per_level);
        largest = std::max(largest, per_level);
        EXPECT_EQ(statistics.references, triangles.size());
        EXPECT_LE(static_cast<double>(statistics.bytes), 120 * count);
    }
    EXPECT_LE(largest, 1.6 * smallest);
}

// SAH cost of splitting every cell in the middle of its longest side, by the boxes of the triangles.
double middle_split_cost(const Bounds& cell, const std::vector<Bounds>& boxes, int depth, const KdOptions& options) {
    if (boxes.size() <= 16 || depth == 0)
        return half_area(cell) * options.intersection_cost * std::ceil(static_cast<double>(boxes.size()) / lanes);
    const glm::vec3 size = cell.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float middle = (cell.lower[axis] + cell.upper[axis]) / 2;
    Bounds lower = cell, upper = cell;
    lower.upper[axis] = upper.lower[axis] = middle;
    std::vector<Bounds> below, above;
    for (const Bounds& box : boxes) {
        if (box.lower[axis] < middle) below.push_back(box);
        if (box.upper[axis] >= middle) above.push_back(box);
    }
    return half_area(cell) * options.traversal_cost + middle_split_cost(lower, below, depth - 1, options) +
           middle_split_cost(upper, above, depth - 1, options);
}

TEST(KdTree, IsFarCheaperToTraverseThanOneSplitInTheMiddle) {
    for (const auto& triangles : {bumpy_ball(100), triangle_soup(5, 20000, 0.05f)}) {
        BuildStatistics statistics;
        const KdOptions options;
        const Hierarchy hierarchy = build_kd_tree({triangles, {}}, options, &statistics);
        std::vector<Bounds> boxes;
        boxes.reserve(triangles.size());
        for (const TriangleCorners& t : triangles) boxes.push_back(bounds_of(t));
        const double middle =
            middle_split_cost(hierarchy.bounds, boxes, std::get<KdTree>(hierarchy.tree).depth, options) /
            half_area(hierarchy.bounds);
        EXPECT_LT(statistics.sah_cost, 0.85 * middle);
    }
}

TEST(KdTree, KeepsToItsDepthLimit) {
    const auto triangles = triangle_soup(6, 5000, 0.1f);
    for (const int limit : {1, 5, 8}) {
        KdOptions options;
        options.depth_limit = limit;
        BuildStatistics statistics;
        const Hierarchy hierarchy = build_kd_tree({triangles, {}}, options, &statistics);
        EXPECT_EQ(std::get<KdTree>(hierarchy.tree).depth, limit);
        EXPECT_EQ(statistics.depth, limit);
        EXPECT_EQ(validate(hierarchy, {triangles, {}}), "");
    }
}

// Every plane cuts every triangle of such a scene, so that a tree without a budget would not end.
TEST(KdTree, KeepsItsMemoryWhereEverythingOverlaps) {
    const auto triangles = triangle_soup(7, 4000, 4);
    BuildStatistics statistics;
    const Hierarchy hierarchy = build_kd_tree({triangles, {}}, with_leaf_limit(1), &statistics);
    EXPECT_LE(statistics.references, 8 * triangles.size() + (1u << 17));
    EXPECT_GT(statistics.leaves, 100u);
}

TEST(Hierarchies, HoldAMillionCoincidentTriangles) {
    const std::vector<TriangleCorners> heap(1 << 20, triangle_soup(8, 1, 1)[0]);
    const Shapes shapes{heap, {}};
    EXPECT_EQ(validate(build_bvh(shapes), shapes), "");
    const Hierarchy kd = build_kd_tree(shapes, {});
    EXPECT_EQ(kd.triangle_blocks.size(), heap.size() / lanes);
    EXPECT_EQ(validate(kd, shapes), "");
}

TEST(Hierarchies, CountWhatTheyHold) {
    const ShapeSet scene = large_scene();
    BuildStatistics kd, bvh;
    const Hierarchy kd_tree = build_kd_tree(scene.shapes(), {}, &kd);
    build_bvh(scene.shapes(), &bvh);
    EXPECT_EQ(kd.inner_nodes + 1, kd.leaves);
    EXPECT_EQ(kd.inner_nodes + kd.leaves, std::get<KdTree>(kd_tree.tree).nodes.size());
    std::uint64_t references = 0;
    for (const TriangleBlock& block : kd_tree.triangle_blocks)
        for (const std::int32_t id : block.id) references += id >= 0;
    for (const SphereBlock& block : kd_tree.sphere_blocks)
        for (const std::int32_t id : block.id) references += id >= 0;
    EXPECT_EQ(kd.references, references);
    EXPECT_EQ(bvh.references, scene.triangles.size() + scene.spheres.size());
    EXPECT_GT(kd.seconds, 0);
    EXPECT_GT(bvh.sah_cost, 0);
}

}  // namespace
}  // namespace raywalk::testing
