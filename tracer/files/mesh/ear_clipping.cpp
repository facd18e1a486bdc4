#include "tracer/files/mesh/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace raywalk {

namespace {

// Twice the area of the triangle, positive where it is counter-clockwise. Coordinates were floats: what is in a line
// along an axis is 0 exactly, and most else too.
double twice_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::uint32_t cell_of(double x, double lower, double cells_per_unit, std::uint32_t cells) {
    const double cell = (x - lower) * cells_per_unit;
    return cell >= 1 ? static_cast<std::uint32_t>(std::min(cell, static_cast<double>(cells - 1))) : 0;
}

// Polygons of fewer corners have a grid of one cell.
constexpr std::size_t worth_a_grid = 32;

}  // namespace

// Leaves out the axis along which the polygon is seen.
void EarClipper::flatten(std::span<const glm::vec3> corners) {
    const glm::dvec3 first(corners[0]);
    glm::dvec3 normal(0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        normal += glm::cross(glm::dvec3(corners[i - 1]) - first, glm::dvec3(corners[i]) - first);
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    points_.clear();
    for (const glm::vec3& corner : corners) points_.emplace_back(corner[u], corner[v]);
}

void EarClipper::make_grid() {
    glm::dvec2 upper = lower_ = points_[0];
    for (const glm::dvec2& p : points_) {
        lower_ = glm::min(lower_, p);
        upper = glm::max(upper, p);
    }
    const glm::dvec2 size = upper - lower_;
    columns_ = rows_ = 1;
    if (points_.size() >= worth_a_grid && size.x > 0 && size.y > 0) {  // two corners a cell
        const double cells = static_cast<double>(points_.size()) / 2;
        columns_ = static_cast<std::uint32_t>(std::clamp(std::sqrt(cells * size.x / size.y), 1.0, cells));
        rows_ = static_cast<std::uint32_t>(std::max(cells / columns_, 1.0));
    }
    cells_per_unit_ = {size.x > 0 ? columns_ / size.x : 0, size.y > 0 ? rows_ / size.y : 0};

    const auto cell_at = [&](const glm::dvec2& p) {
        return cell_of(p.y, lower_.y, cells_per_unit_.y, rows_) * columns_ +
               cell_of(p.x, lower_.x, cells_per_unit_.x, columns_);
    };
    cell_starts_.assign(std::size_t{columns_} * rows_ + 1, 0);
    for (const glm::dvec2& p : points_) ++cell_starts_[cell_at(p)];
    std::inclusive_scan(cell_starts_.begin(), cell_starts_.end(), cell_starts_.begin());
    in_cells_.resize(points_.size());
    for (std::size_t i = points_.size(); i-- > 0;)
        in_cells_[--cell_starts_[cell_at(points_[i])]] = static_cast<std::uint32_t>(i);
}

// Positive where the polygon turns to the left, as it does at a convex corner.
double EarClipper::turn(std::uint32_t corner) const {
    return twice_area(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

// Does the polygon turn back on itself at the corner, or stand still? It can be cut off then whatever lies around it.
bool EarClipper::is_needle(std::uint32_t corner) const {
    const glm::dvec2 arriving = points_[corner] - points_[previous_[corner]];
    const glm::dvec2 leaving = points_[next_[corner]] - points_[corner];
    return turn(corner) == 0 && glm::dot(arriving, leaving) <= 0;
}

// Does the corner keep the triangle a, b, c from being cut off? It does inside; on the triangle's border if the polygon
// goes on into the triangle from there.
bool EarClipper::blocks(std::uint32_t corner, std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec2 &p = points_[corner], &at_a = points_[a], &at_b = points_[b], &at_c = points_[c];
    const double ab = twice_area(at_a, at_b, p), bc = twice_area(at_b, at_c, p), ca = twice_area(at_c, at_a, p);
    if (ab < 0 || bc < 0 || ca < 0) return false;
    if (ab > 0 && bc > 0 && ca > 0) return true;
    if (!touching_blocks_) return false;
    for (const std::uint32_t neighbour : {previous_[corner], next_[corner]}) {
        const glm::dvec2& q = points_[neighbour];
        if ((ab > 0 || twice_area(at_a, at_b, q) > 0) && (bc > 0 || twice_area(at_b, at_c, q) > 0) &&
            (ca > 0 || twice_area(at_c, at_a, q) > 0))
            return true;
    }
    return false;
}

bool EarClipper::is_ear(std::uint32_t corner) {
    if (!(turn(corner) > 0)) return is_needle(corner);
    const std::uint32_t a = previous_[corner], b = corner, c = next_[corner];
    const glm::dvec2 lower = glm::min(glm::min(points_[a], points_[b]), points_[c]);
    const glm::dvec2 upper = glm::max(glm::max(points_[a], points_[b]), points_[c]);
    const std::uint32_t left = cell_of(lower.x, lower_.x, cells_per_unit_.x, columns_);
    const std::uint32_t right = cell_of(upper.x, lower_.x, cells_per_unit_.x, columns_);
    const std::uint32_t bottom = cell_of(lower.y, lower_.y, cells_per_unit_.y, rows_);
    const std::uint32_t top = cell_of(upper.y, lower_.y, cells_per_unit_.y, rows_);
    for (std::uint32_t row = bottom; row <= top; ++row) {
        // Cells of a row follow one another.
        const std::uint32_t begin = cell_starts_[row * columns_ + left], end = cell_starts_[row * columns_ + right + 1];
        steps_left_ -= std::min<std::uint64_t>(steps_left_, end - begin + 1);
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t other = in_cells_[i];
            if (other == a || other == b || other == c || states_[other] == State::gone) continue;
            if (blocks(other, a, b, c)) return false;
        }
    }
    return true;
}

void EarClipper::clip(std::uint32_t corner) {
    const std::uint32_t before = previous_[corner], after = next_[corner];
    triangles_.push_back({before, corner, after});
    next_[before] = after;
    previous_[after] = before;
    states_[corner] = State::gone;
    // Others become no ears by this: their triangles would lie within the polygon as it was.
    states_[before] = states_[after] = State::unknown;
}

// Where no corner is an ear: one without area, else (the polygon crosses itself) a convex one, else any.
std::uint32_t EarClipper::least_wrong(std::uint32_t start, std::size_t left) const {
    std::uint32_t convex = start;
    for (std::uint32_t corner = start; left > 0; --left, corner = next_[corner]) {
        const double area = turn(corner);
        if (area == 0) return corner;
        if (area > 0) convex = corner;
    }
    return convex;
}

std::span<const EarClipper::Triangle> EarClipper::cut(std::span<const glm::vec3> corners) {
    const std::size_t count = corners.size();
    triangles_.clear();
    flatten(corners);
    make_grid();
    next_.resize(count);
    previous_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        next_[i] = i + 1 < count ? i + 1 : 0;
        previous_[next_[i]] = i;
    }
    states_.assign(count, State::unknown);
    touching_blocks_ = true;

    // Begins at a needle if there is one.
    std::uint32_t at = 0;
    while (at + 1 < count && !is_needle(at)) ++at;
    std::size_t left = count, no_ears = 0;  // in a row
    while (left > 3) {
        if (steps_left_ == 0) return {};
        --steps_left_;
        if (no_ears == left) {
            steps_left_ -= std::min<std::uint64_t>(steps_left_, left);
            at = least_wrong(at, left);
            if (touching_blocks_ && turn(at) != 0) {
                touching_blocks_ = false;
                std::ranges::replace(states_, State::no_ear, State::unknown);
                no_ears = 0;
                continue;
            }
        } else if (states_[at] == State::no_ear || !is_ear(at)) {
            states_[at] = State::no_ear;
            at = next_[at];
            ++no_ears;
            continue;
        }
        clip(at);
        --left;
        no_ears = 0;
        // Needles first: they hide on which side the polygon is. Else not beside this ear: two that share a corner make
        // slivers.
        const std::uint32_t before = previous_[at], after = next_[at];
        at = is_needle(before) ? before : is_needle(after) ? after : next_[after];
    }
    triangles_.push_back({previous_[at], at, next_[at]});
    return triangles_;
}

}  // namespace raywalk
