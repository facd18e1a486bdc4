// Both hierarchies find what a loop over all shapes finds.
#include <gtest/gtest.h>

#include "tests/oracle/compiled_naive.h"
#include "tests/oracle/compiled_shapes.h"
#include "tracer/compiled/hierarchy.h"
#include "tracer/ground/sanitized.h"

namespace raywalk::testing {
namespace {

constexpr int rays_per_scene = RAYWALK_SANITIZED ? 400 : 24000;  // of each of three hierarchies; 28 scenes: 2 million

// Leaves of one shape: a deep tree even of a small scene.
KdOptions deep() {
    KdOptions options;
    options.leaf_limit = 1;
    options.traversal_cost = 0.01f;
    options.depth_limit = 40;
    return options;
}

class Hits : public ::testing::TestWithParam<ShapeSet> {
  protected:
    void compare(const Hierarchy& hierarchy, std::uint32_t seed) {
        const Shapes shapes = GetParam().shapes();
        Random random(seed);
        int hits = 0, unlike = 0;
        for (int i = 0; i < rays_per_scene; ++i) {
            const NaiveRay ray = awkward_ray(random, GetParam());
            const NaiveHit expected = nearest_by_loop(ray, shapes);
            const NaiveHit found = nearest_by_tree(ray, hierarchy, shapes);
            hits += expected.id >= 0;
            if (found == expected) continue;
            // Rounding may decide about a hit on a shape's very rim: then what is found lies between the hits that
            // only rounding makes and those that are certain.
            ++unlike;
            const double certain = nearest_by_loop(ray, shapes, 1e-7).t;
            ASSERT_TRUE(found.t >= expected.t && found.t <= certain * (1 + 1e-7))
                << "ray " << i << " from " << ray.origin[0] << ' ' << ray.origin[1] << ' ' << ray.origin[2] << " along "
                << ray.direction[0] << ' ' << ray.direction[1] << ' ' << ray.direction[2] << ": found " << found.id
                << " at " << found.t << ", expected " << expected.id << " at " << expected.t;
        }
        EXPECT_LE(unlike, rays_per_scene / 5000);
        if (!shapes.triangles.empty() && GetParam().name.find("one") == std::string::npos &&
            GetParam().name != "without_area") {
            EXPECT_GT(hits, rays_per_scene / 100) << "too few rays hit anything to prove much";
        }
    }
};

TEST_P(Hits, OfTheKdTreeAreThoseOfALoop) { compare(build_kd_tree(GetParam().shapes(), {}), 1); }
TEST_P(Hits, OfADeepKdTreeAreThoseOfALoop) { compare(build_kd_tree(GetParam().shapes(), deep()), 2); }
TEST_P(Hits, OfTheBvhAreThoseOfALoop) { compare(build_bvh(GetParam().shapes()), 3); }

// All but the one in which double precision cannot tell hits apart either.
std::vector<ShapeSet> scenes_to_hit() {
    std::vector<ShapeSet> scenes = awkward_scenes();
    std::erase_if(scenes, [](const ShapeSet& scene) { return scene.name == "every_float"; });
    return scenes;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Hits, ::testing::ValuesIn(scenes_to_hit()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace raywalk::testing
