// Scenes of bare shapes that hierarchies are tested on: random ones and every degenerate one we could think of.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tracer/compiled/hierarchy.h"

namespace raywalk::testing {

struct ShapeSet {
    std::string name;
    std::vector<TriangleCorners> triangles;
    std::vector<SphereShape> spheres;
    [[nodiscard]] Shapes shapes() const { return {triangles, spheres}; }
};

class Random {
  public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) { return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(engine_() % n); }
    glm::vec3 point(float low, float high) { return {between(low, high), between(low, high), between(low, high)}; }

  private:
    std::mt19937 engine_;  // the same numbers on every machine
};

// `count` triangles with corners up to `size` apart, in the cube [-1, 1]^3.
std::vector<TriangleCorners> triangle_soup(std::uint32_t seed, int count, float size);

// A closed, bumpy surface of 2 n * n triangles: neighbours share corners, like the meshes of real scenes.
std::vector<TriangleCorners> bumpy_ball(int n);

// Small scenes, random and degenerate.
std::vector<ShapeSet> awkward_scenes();

}  // namespace raywalk::testing
