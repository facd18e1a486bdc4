// Triangles that fill a polygon, convex or not: ear clipping, after Held, "FIST" (2001), and mapbox/earcut.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace raywalk {

// Cuts polygons one after the other, in memory that is used again.
class EarClipper {
  public:
    using Triangle = std::array<std::uint32_t, 3>;

    // A step is a look at one corner or one cell of the grid; without any left, polygons are refused.
    explicit EarClipper(std::uint64_t steps) : steps_left_(steps) {}

    // corners.size() - 2 triangles, wound as the polygon, which is seen along its normal: it may touch itself and have
    // corners in a line (the triangles may be without area then); where it crosses itself they overlap. Steps grow as
    // the square of the corners at worst, and nearly in proportion to them for most polygons. Empty where there were
    // not enough steps.
    std::span<const Triangle> cut(std::span<const glm::vec3> corners);

  private:
    enum class State : unsigned char { unknown, no_ear, gone };

    void flatten(std::span<const glm::vec3> corners);
    void make_grid();
    [[nodiscard]] bool is_ear(std::uint32_t corner);
    [[nodiscard]] bool is_needle(std::uint32_t corner) const;
    [[nodiscard]] bool blocks(std::uint32_t corner, std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] double turn(std::uint32_t corner) const;
    void clip(std::uint32_t corner);
    [[nodiscard]] std::uint32_t least_wrong(std::uint32_t start, std::size_t left) const;

    std::uint64_t steps_left_;
    std::vector<glm::dvec2> points_;  // counter-clockwise
    std::vector<std::uint32_t> previous_, next_;
    std::vector<State> states_;
    // Corners by cell of a grid over the polygon: those of cell i are in_cells_[cell_starts_[i]] up to the next's.
    std::vector<std::uint32_t> cell_starts_, in_cells_;
    glm::dvec2 lower_ = {}, cells_per_unit_ = {};
    std::uint32_t columns_ = 1, rows_ = 1;
    bool touching_blocks_ = true;
    std::vector<Triangle> triangles_;
};

}  // namespace raywalk
