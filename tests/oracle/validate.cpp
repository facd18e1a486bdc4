// What must be true of a hierarchy, checked from the shapes alone and with none of the builders' code for it.
#include "tests/oracle/validate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>
#include <vector>

#include "tracer/compiled/shape_bounds.h"

namespace raywalk {

namespace {

using Vector = std::array<double, 3>;

template <class... Words>
std::string text(const Words&... words) {
    std::ostringstream stream;
    (stream << ... << words);
    return stream.str();
}

double along(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross_product(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Distance that rounding may have moved something near the box.
double tolerance(const Bounds& box) { return 4 * rounding_margin * largest_magnitude(box); }

// The box grown by `by`, or shrunk where that is negative; false when nothing is left.
struct Cell {
    Vector center, half;
    bool exists = true;
    Cell(const Bounds& box, double by) {
        for (int k = 0; k < 3; ++k) {
            center[k] = (double{box.lower[k]} + box.upper[k]) / 2;
            half[k] = (double{box.upper[k]} - box.lower[k]) / 2 + by;
            exists = exists && half[k] >= 0;
        }
    }
};

// Separating axes: three of the box, the triangle's normal, nine cross products.
bool meets(const TriangleCorners& triangle, const Cell& cell) {
    if (!cell.exists) return false;
    std::array<Vector, 3> p;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) p[i][k] = triangle.p[i][k] - cell.center[k];
    const auto separates = [&](const Vector& axis) {
        const double a = along(axis, p[0]), b = along(axis, p[1]), c = along(axis, p[2]);
        const double reach =
            std::fabs(axis[0]) * cell.half[0] + std::fabs(axis[1]) * cell.half[1] + std::fabs(axis[2]) * cell.half[2];
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    std::array<Vector, 3> edge;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) edge[i][k] = p[(i + 1) % 3][k] - p[i][k];
    for (int k = 0; k < 3; ++k) {
        Vector unit{};
        unit[k] = 1;
        if (separates(unit)) return false;
        for (const Vector& e : edge)
            if (separates(cross_product(unit, e))) return false;
    }
    return !separates(cross_product(edge[0], edge[1]));
}

bool meets(const SphereShape& sphere, const Cell& cell) {
    if (!cell.exists) return false;
    double near = 0, far = 0;
    for (int k = 0; k < 3; ++k) {
        const double d = std::fabs(sphere.center[k] - cell.center[k]);
        near += std::pow(std::max(d - cell.half[k], 0.0), 2);
        far += std::pow(d + cell.half[k], 2);
    }
    const double r = std::fabs(sphere.radius);
    return near <= r * r && r * r <= far;
}

// A sphere's size counts in how far rounding may move its surface.
double tolerance(const SphereShape& sphere, const Bounds& box) {
    return tolerance(box) + 8 * rounding_margin *
                                (std::fabs(sphere.radius) + std::fabs(sphere.center.x) + std::fabs(sphere.center.y) +
                                 std::fabs(sphere.center.z));
}
double tolerance(const TriangleCorners&, const Bounds& box) { return tolerance(box); }

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool padding(const TriangleBlock& block, int lane) {
    for (const auto& corner : block.corner)
        for (const auto& axis : corner)
            if (!std::isnan(axis[lane])) return false;
    return block.id[lane] == -1;
}
bool padding(const SphereBlock& block, int lane) {
    for (const auto& axis : block.center)
        if (!std::isnan(axis[lane])) return false;
    return block.radius[lane] == 0 && block.id[lane] == -1;
}
bool holds(const TriangleBlock& block, int lane, const TriangleCorners& triangle) {
    for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            if (!same(block.corner[corner][axis][lane], triangle.p[corner][axis])) return false;
    return true;
}
bool holds(const SphereBlock& block, int lane, const SphereShape& sphere) {
    for (int axis = 0; axis < 3; ++axis)
        if (!same(block.center[axis][lane], sphere.center[axis])) return false;
    return same(block.radius[lane], sphere.radius);
}

// The blocks of one kind and which of them leaves have taken.
template <class Block, class Shape>
class Blocks {
  public:
    Blocks(const AlignedVector<Block>& blocks, std::span<const Shape> shapes, std::string kind)
        : kind_(std::move(kind)), blocks_(blocks), shapes_(shapes), taken_(blocks.size()) {}

    // Ids of a leaf's blocks, sorted; what is wrong with them otherwise.
    std::string take(std::uint32_t first, std::uint32_t count, std::vector<std::int32_t>& ids) {
        ids.clear();
        if (first + std::uint64_t{count} > blocks_.size())
            return text(kind_, " blocks ", first, " + ", count, " of ", blocks_.size());
        for (std::uint32_t b = first; b < first + count; ++b) {
            if (taken_[b]) return text(kind_, " block ", b, " belongs to two leaves");
            taken_[b] = true;
            for (int lane = 0; lane < lanes; ++lane) {
                const std::int32_t id = blocks_[b].id[lane];
                if (id == -1) {
                    if (!padding(blocks_[b], lane)) return text(kind_, " block ", b, ": lane ", lane, " is not empty");
                    if (lane == 0) return text(kind_, " block ", b, " is empty");
                    if (b + 1 < first + count)
                        return text(kind_, " block ", b, " is not full, but not its leaf's last");
                    continue;
                }
                if (lane > 0 && blocks_[b].id[lane - 1] == -1) return text(kind_, " block ", b, " has a gap");
                if (id < 0 || static_cast<std::size_t>(id) >= shapes_.size())
                    return text(kind_, " block ", b, " names ", kind_, ' ', id);
                if (!finite(shapes_[id])) return text(kind_, ' ', id, " is not finite");
                if (!holds(blocks_[b], lane, shapes_[id]))
                    return text(kind_, " block ", b, " differs from ", kind_, ' ', id);
                ids.push_back(id);
            }
        }
        std::sort(ids.begin(), ids.end());
        const auto twice = std::adjacent_find(ids.begin(), ids.end());
        return twice == ids.end() ? "" : text(kind_, ' ', *twice, " is twice in a leaf");
    }
    std::string all_taken() const {
        const auto left = std::find(taken_.begin(), taken_.end(), false);
        return left == taken_.end() ? "" : text(kind_, " block ", left - taken_.begin(), " belongs to no leaf");
    }
    [[nodiscard]] std::span<const Shape> shapes() const { return shapes_; }
    [[nodiscard]] const std::string& kind() const { return kind_; }

  private:
    std::string kind_;
    const AlignedVector<Block>& blocks_;
    std::span<const Shape> shapes_;
    std::vector<bool> taken_;
};

std::string outside(const Bounds& inner, const Bounds& outer) {
    for (int k = 0; k < 3; ++k)
        if (inner.lower[k] < outer.lower[k] || inner.upper[k] > outer.upper[k]) return text(" sticks out on axis ", k);
    return "";
}

struct Checker {
    const Hierarchy& hierarchy;
    Blocks<TriangleBlock, TriangleCorners> triangles;
    Blocks<SphereBlock, SphereShape> spheres;

    Checker(const Hierarchy& h, const Shapes& shapes)
        : hierarchy(h),
          triangles(h.triangle_blocks, shapes.triangles, "triangle"),
          spheres(h.sphere_blocks, shapes.spheres, "sphere") {}

    std::string check_bounds() const {
        const auto check = [&](const auto& blocks) -> std::string {
            for (std::size_t i = 0; i < blocks.shapes().size(); ++i) {
                if (!finite(blocks.shapes()[i])) continue;
                const std::string wrong = outside(bounds_of(blocks.shapes()[i]), hierarchy.bounds);
                if (!wrong.empty()) return text(blocks.kind(), ' ', i, wrong, " of the scene's box");
            }
            return "";
        };
        const std::string wrong = check(triangles);
        return wrong.empty() ? check(spheres) : wrong;
    }
};

// --- kd-tree

struct LeafShapes {
    std::vector<std::int32_t> triangles, spheres;
};

class KdChecker : Checker {
  public:
    KdChecker(const KdTree& tree, const Hierarchy& h, const Shapes& shapes)
        : Checker(h, shapes), tree_(tree), leaves_(tree.leaves.size()), seen_(tree.nodes.size()) {}

    std::string check() {
        if (tree_.nodes.empty()) return "the tree has no node";
        if (tree_.depth > KdTree::max_depth) return text("depth ", tree_.depth, " is over ", KdTree::max_depth);
        std::string wrong = check_bounds();
        if (wrong.empty()) wrong = check_node(0, hierarchy.bounds, 0);
        if (wrong.empty() && deepest_ != tree_.depth) wrong = text("depth is ", deepest_, ", not ", tree_.depth);
        if (wrong.empty() && std::find(seen_.begin(), seen_.end(), false) != seen_.end())
            wrong = "a node has no parent";
        if (wrong.empty() && leaf_count_ != tree_.leaves.size()) wrong = "a leaf belongs to no node";
        if (wrong.empty()) wrong = triangles.all_taken();
        if (wrong.empty()) wrong = spheres.all_taken();
        if (wrong.empty()) wrong = check_presence(triangles, &LeafShapes::triangles);
        if (wrong.empty()) wrong = check_presence(spheres, &LeafShapes::spheres);
        return wrong;
    }

  private:
    std::string check_node(std::uint32_t index, const Bounds& cell, int depth) {
        if (index >= tree_.nodes.size()) return text("node ", index, " of ", tree_.nodes.size());
        if (seen_[index]) return text("node ", index, " has two parents");
        seen_[index] = true;
        const KdNode node = tree_.nodes[index];
        if (node.leaf()) return check_leaf(index, node.index(), cell, depth);
        const int axis = node.axis();
        if (!(node.split > cell.lower[axis] && node.split < cell.upper[axis]))
            return text("node ", index, ": the plane ", node.split, " is outside its cell");
        Bounds lower = cell, upper = cell;
        lower.upper[axis] = upper.lower[axis] = node.split;
        const std::string wrong = check_node(node.index(), lower, depth + 1);
        return wrong.empty() ? check_node(node.index() + 1, upper, depth + 1) : wrong;
    }

    std::string check_leaf(std::uint32_t node, std::uint32_t index, const Bounds& cell, int depth) {
        if (index >= tree_.leaves.size()) return text("node ", node, ": leaf ", index, " of ", tree_.leaves.size());
        deepest_ = std::max(deepest_, depth);
        ++leaf_count_;
        const KdLeaf& leaf = tree_.leaves[index];
        std::string wrong = triangles.take(leaf.first_triangle_block, leaf.triangle_blocks, leaves_[index].triangles);
        if (wrong.empty()) wrong = spheres.take(leaf.first_sphere_block, leaf.sphere_blocks, leaves_[index].spheres);
        if (!wrong.empty()) return text("leaf ", index, ": ", wrong);
        const auto far = [&](const auto& blocks, const std::vector<std::int32_t>& ids) -> std::string {
            for (const std::int32_t id : ids) {
                const auto& shape = blocks.shapes()[id];
                if (!meets(shape, Cell(cell, tolerance(shape, cell))))
                    return text("leaf ", index, ": ", blocks.kind(), ' ', id, " is outside its cell");
            }
            return "";
        };
        wrong = far(triangles, leaves_[index].triangles);
        return wrong.empty() ? far(spheres, leaves_[index].spheres) : wrong;
    }

    // Every shape is somewhere, and in every leaf whose cell it certainly enters.
    template <class Kind>
    std::string check_presence(const Kind& blocks, std::vector<std::int32_t> LeafShapes::*ids) const {
        std::vector<bool> somewhere(blocks.shapes().size());
        for (const LeafShapes& leaf : leaves_)
            for (const std::int32_t id : leaf.*ids) somewhere[id] = true;
        for (std::size_t id = 0; id < somewhere.size(); ++id) {
            if (!finite(blocks.shapes()[id])) continue;
            if (!somewhere[id]) return text(blocks.kind(), ' ', id, " is in no leaf");
            std::string wrong = check_shape(blocks, ids, static_cast<std::int32_t>(id), 0, hierarchy.bounds);
            if (!wrong.empty()) return wrong;
        }
        return "";
    }

    template <class Kind>
    std::string check_shape(const Kind& blocks, std::vector<std::int32_t> LeafShapes::*ids, std::int32_t id,
                            std::uint32_t index, const Bounds& cell) const {
        const auto& shape = blocks.shapes()[id];
        if (!meets(shape, Cell(cell, -tolerance(shape, cell)))) return "";
        const KdNode node = tree_.nodes[index];
        if (node.leaf()) {
            const auto& there = leaves_[node.index()].*ids;
            if (std::binary_search(there.begin(), there.end(), id)) return "";
            return text("leaf ", node.index(), " lacks ", blocks.kind(), ' ', id);
        }
        Bounds lower = cell, upper = cell;
        lower.upper[node.axis()] = upper.lower[node.axis()] = node.split;
        const std::string wrong = check_shape(blocks, ids, id, node.index(), lower);
        return wrong.empty() ? check_shape(blocks, ids, id, node.index() + 1, upper) : wrong;
    }

    const KdTree& tree_;
    std::vector<LeafShapes> leaves_;
    std::vector<bool> seen_;
    std::size_t leaf_count_ = 0;
    int deepest_ = 0;
};

// --- BVH

class BvhChecker : Checker {
  public:
    BvhChecker(const Bvh& tree, const Hierarchy& h, const Shapes& shapes)
        : Checker(h, shapes), tree_(tree), seen_(tree.nodes.size()) {}

    std::string check() {
        if (tree_.nodes.empty()) return "the tree has no node";
        if (tree_.depth > Bvh::max_depth) return text("depth ", tree_.depth, " is over ", Bvh::max_depth);
        triangle_times_.resize(triangles.shapes().size());
        sphere_times_.resize(spheres.shapes().size());
        std::string wrong = check_bounds();
        if (wrong.empty()) wrong = check_node(0, hierarchy.bounds, 0);
        if (wrong.empty() && deepest_ != tree_.depth) wrong = text("depth is ", deepest_, ", not ", tree_.depth);
        if (wrong.empty() && std::find(seen_.begin(), seen_.end(), false) != seen_.end())
            wrong = "a node has no parent";
        if (wrong.empty()) wrong = triangles.all_taken();
        if (wrong.empty()) wrong = spheres.all_taken();
        if (wrong.empty()) wrong = once(triangles, triangle_times_);
        if (wrong.empty()) wrong = once(spheres, sphere_times_);
        return wrong;
    }

  private:
    std::string check_node(std::uint32_t index, const Bounds& box, int depth) {
        if (index >= tree_.nodes.size()) return text("node ", index, " of ", tree_.nodes.size());
        if (seen_[index]) return text("node ", index, " has two parents");
        seen_[index] = true;
        deepest_ = std::max(deepest_, depth);
        const BvhNode& node = tree_.nodes[index];
        std::uint32_t next_child = 0;  // inner children follow each other
        for (int slot = 0; slot < lanes; ++slot) {
            Bounds child;
            for (int axis = 0; axis < 3; ++axis) {
                child.lower[axis] = node.lower[axis][slot];
                child.upper[axis] = node.upper[axis][slot];
            }
            if (child.empty()) {
                if (child == Bounds{}) continue;
                return text("node ", index, ": slot ", slot, " has a box that is neither whole nor empty");
            }
            std::string wrong = outside(child, box);
            if (!wrong.empty()) return text("node ", index, ": child ", slot, wrong, " of its parent");
            const BvhReference reference{node.child[slot]};
            if (reference.leaf()) {
                wrong = check_leaf(reference, child);
            } else {
                if (next_child != 0 && reference.bits != next_child)
                    return text("node ", index, ": its inner children are not contiguous");
                next_child = reference.bits + 1;
                wrong = check_node(reference.bits, child, depth + 1);
            }
            if (!wrong.empty()) return text("node ", index, ": ", wrong);
        }
        return "";
    }

    std::string check_leaf(BvhReference reference, const Bounds& box) {
        std::vector<std::int32_t> ids;
        const auto check = [&](auto& blocks, std::vector<int>& times) -> std::string {
            std::string wrong = blocks.take(reference.first(), reference.blocks(), ids);
            for (const std::int32_t id : ids) {
                if (!wrong.empty()) break;
                ++times[id];
                wrong = outside(bounds_of(blocks.shapes()[id]), box);
                if (!wrong.empty()) wrong = text(blocks.kind(), ' ', id, wrong, " of its leaf");
            }
            return wrong;
        };
        return reference.spheres() ? check(spheres, sphere_times_) : check(triangles, triangle_times_);
    }

    template <class Kind>
    static std::string once(const Kind& blocks, const std::vector<int>& times) {
        for (std::size_t id = 0; id < times.size(); ++id)
            if (times[id] != (finite(blocks.shapes()[id]) ? 1 : 0))
                return text(blocks.kind(), ' ', id, " is in ", times[id], " leaves");
        return "";
    }

    const Bvh& tree_;
    std::vector<bool> seen_;
    std::vector<int> triangle_times_, sphere_times_;
    int deepest_ = 0;
};

}  // namespace

std::string validate(const Hierarchy& hierarchy, const Shapes& shapes) {
    if (const auto* kd = std::get_if<KdTree>(&hierarchy.tree)) return KdChecker(*kd, hierarchy, shapes).check();
    return BvhChecker(std::get<Bvh>(hierarchy.tree), hierarchy, shapes).check();
}

}  // namespace raywalk
