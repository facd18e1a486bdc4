// validate() finds what it is there to find: each test breaks one thing in a good hierarchy.
#include <gtest/gtest.h>

#include <limits>

#include "tests/oracle/compiled_shapes.h"
#include "tests/oracle/validate.h"
#include "tracer/compiled/hierarchy.h"

namespace raywalk::testing {
namespace {

struct Broken {
    ShapeSet scene{"", bumpy_ball(20), {{{0, 0, 0}, 0.5f}, {{1, 1, 1}, 0.25f}}};
    Hierarchy hierarchy;
    explicit Broken(bool bvh) : hierarchy(bvh ? build_bvh(scene.shapes()) : build_kd_tree(scene.shapes(), {})) {}
    KdTree& kd() { return std::get<KdTree>(hierarchy.tree); }
    Bvh& bvh() { return std::get<Bvh>(hierarchy.tree); }
    [[nodiscard]] std::string verdict() const { return validate(hierarchy, scene.shapes()); }
    // A block with an empty last lane.
    TriangleBlock& partial_block() {
        for (TriangleBlock& block : hierarchy.triangle_blocks)
            if (block.id[lanes - 1] == -1) return block;
        throw std::logic_error("every block is full");
    }
};

void remove_first_triangle(TriangleBlock& block) {
    int last = lanes - 1;
    while (block.id[last] == -1) --last;
    for (auto& corner : block.corner)
        for (auto& axis : corner) {
            axis[0] = axis[last];
            axis[last] = std::numeric_limits<float>::quiet_NaN();
        }
    block.id[0] = block.id[last];
    block.id[last] = -1;
}

class Validate : public ::testing::TestWithParam<bool> {};  // true: the BVH

TEST_P(Validate, AcceptsAGoodTree) { EXPECT_EQ(Broken(GetParam()).verdict(), ""); }

TEST_P(Validate, NoticesALostShape) {
    Broken broken(GetParam());
    remove_first_triangle(broken.partial_block());
    EXPECT_NE(broken.verdict(), "");
}
TEST_P(Validate, SeesAWrongCorner) {
    Broken broken(GetParam());
    broken.hierarchy.triangle_blocks[0].corner[1][2][0] += 0.5f;
    EXPECT_NE(broken.verdict().find("differs from"), std::string::npos) << broken.verdict();
}
TEST_P(Validate, SeesAnIdOutOfRange) {
    Broken broken(GetParam());
    broken.hierarchy.triangle_blocks[0].id[0] = 1 << 20;
    EXPECT_NE(broken.verdict().find("names triangle"), std::string::npos) << broken.verdict();
}
TEST_P(Validate, SeesPaddingThatCouldBeHit) {
    Broken broken(GetParam());
    broken.partial_block().corner[0][0][lanes - 1] = 0;
    EXPECT_NE(broken.verdict().find("is not empty"), std::string::npos) << broken.verdict();
}
TEST_P(Validate, SeesAShapeTwice) {
    Broken broken(GetParam());
    TriangleBlock& block = broken.partial_block();
    for (auto& corner : block.corner)
        for (auto& axis : corner) axis[1] = axis[0];
    block.id[1] = block.id[0];
    EXPECT_NE(broken.verdict(), "");
}
TEST_P(Validate, SeesAWrongSphere) {
    Broken broken(GetParam());
    broken.hierarchy.sphere_blocks[0].radius[0] *= 2;
    EXPECT_NE(broken.verdict().find("differs from sphere"), std::string::npos) << broken.verdict();
}
TEST_P(Validate, SeesABlockOfNoLeaf) {
    Broken broken(GetParam());
    broken.hierarchy.triangle_blocks.push_back(broken.hierarchy.triangle_blocks[0]);
    EXPECT_NE(broken.verdict().find("belongs to no leaf"), std::string::npos) << broken.verdict();
}
TEST_P(Validate, SeesSceneBoundsThatAreTooSmall) {
    Broken broken(GetParam());
    broken.hierarchy.bounds.upper.y = 0.5f;
    EXPECT_NE(broken.verdict().find("scene's box"), std::string::npos) << broken.verdict();
}
INSTANTIATE_TEST_SUITE_P(OfEither, Validate, ::testing::Bool(),
                         [](const auto& tree) { return tree.param ? "Bvh" : "KdTree"; });

TEST(ValidateKdTree, SeesAMovedPlane) {
    Broken broken(false);
    broken.kd().nodes[0].split += 0.3f;
    EXPECT_NE(broken.verdict(), "");
}
TEST(ValidateKdTree, SeesAPlaneOutsideItsCell) {
    Broken broken(false);
    broken.kd().nodes[0].split = 50;
    EXPECT_NE(broken.verdict().find("outside its cell"), std::string::npos) << broken.verdict();
}
TEST(ValidateKdTree, SeesACycle) {
    Broken broken(false);
    broken.kd().nodes[0].data = 0u << 2 | static_cast<std::uint32_t>(broken.kd().nodes[0].axis());
    EXPECT_NE(broken.verdict().find("two parents"), std::string::npos) << broken.verdict();
}
TEST(ValidateKdTree, SeesAChildOutOfRange) {
    Broken broken(false);
    broken.kd().nodes[0].data += 1u << 20;
    EXPECT_NE(broken.verdict().find(" of "), std::string::npos) << broken.verdict();
}
TEST(ValidateKdTree, SeesAWrongDepth) {
    Broken broken(false);
    broken.kd().depth += 1;
    EXPECT_NE(broken.verdict().find("depth is"), std::string::npos) << broken.verdict();
}
TEST(ValidateKdTree, SeesALeafThatForgotItsBlocks) {
    Broken broken(false);
    for (KdLeaf& leaf : broken.kd().leaves) leaf.triangle_blocks = 0;
    EXPECT_NE(broken.verdict(), "");
}

TEST(ValidateBvh, SeesABoxThatDoesNotHoldItsChild) {
    Broken broken(true);
    broken.bvh().nodes[0].upper[0][0] = broken.bvh().nodes[0].lower[0][0];
    EXPECT_NE(broken.verdict().find("sticks out"), std::string::npos) << broken.verdict();
}
TEST(ValidateBvh, SeesAHalfEmptySlot) {
    Broken broken(true);
    std::swap(broken.bvh().nodes[0].upper[1][2], broken.bvh().nodes[0].lower[1][2]);
    EXPECT_NE(broken.verdict().find("neither whole nor empty"), std::string::npos) << broken.verdict();
}
TEST(ValidateBvh, SeesASharedChild) {
    Broken broken(true);
    broken.bvh().nodes[0].child[1] = broken.bvh().nodes[0].child[0];
    EXPECT_NE(broken.verdict(), "");
}

}  // namespace
}  // namespace raywalk::testing
