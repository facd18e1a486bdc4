#include "tests/oracle/compiled_naive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raywalk::testing {

namespace {

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }
Vector vector(const glm::vec3& v) { return {v.x, v.y, v.z}; }
Vector origin_of(const NaiveRay& ray) { return {ray.origin[0], ray.origin[1], ray.origin[2]}; }
Vector direction_of(const NaiveRay& ray) { return {ray.direction[0], ray.direction[1], ray.direction[2]}; }

// Room for the rounding of t, generous against double precision and small against single precision.
constexpr double slack = 1e-9;

void test(const NaiveRay& ray, const TriangleCorners& triangle, std::int64_t id, NaiveHit& nearest, double rim = 0) {
    const Vector o = origin_of(ray), d = direction_of(ray), a = vector(triangle.p[0]);
    const Vector e1 = minus(vector(triangle.p[1]), a), e2 = minus(vector(triangle.p[2]), a);
    const Vector p = cross(d, e2);
    const double determinant = dot(e1, p);
    // Rays in the plane, and triangles without area, meet nowhere in particular.
    if (!(std::fabs(determinant) > 1e-8 * length(e1) * length(e2) * length(d))) return;
    const Vector s = minus(o, a), q = cross(s, e1);
    const double u = dot(s, p) / determinant, v = dot(d, q) / determinant, t = dot(e2, q) / determinant;
    if (!(u >= rim && v >= rim && u + v <= 1 - rim && t > rim)) return;
    if (t < nearest.t || (t == nearest.t && id < nearest.id)) nearest = {t, id};
}

void test(const NaiveRay& ray, const SphereShape& sphere, std::int64_t id, NaiveHit& nearest, double rim = 0) {
    if (!(std::isfinite(sphere.radius) && std::isfinite(sphere.center.x))) return;
    const Vector o = origin_of(ray), d = direction_of(ray), c = minus(vector(sphere.center), o);
    const double dd = dot(d, d), middle = dot(c, d) / dd;
    const Vector away = minus(c, {middle * d[0], middle * d[1], middle * d[2]});
    const double room = double{sphere.radius} * sphere.radius - dot(away, away);
    if (!(room >= rim * sphere.radius * sphere.radius)) return;
    const double half = std::sqrt(room / dd);
    for (const double t : {middle - half, middle + half})
        if (t > rim && (t < nearest.t || (t == nearest.t && id < nearest.id))) nearest = {t, id};
}

class Traversal {
  public:
    Traversal(const NaiveRay& ray, const Hierarchy& hierarchy, const Shapes& shapes)
        : ray_(ray), hierarchy_(hierarchy), shapes_(shapes) {}

    NaiveHit nearest() {
        double t0 = 0, t1 = 1e300;
        if (crosses(hierarchy_.bounds, t0, t1)) {
            if (const auto* kd = std::get_if<KdTree>(&hierarchy_.tree))
                visit(*kd, 0, t0, t1);
            else
                visit(std::get<Bvh>(hierarchy_.tree), 0);
        }
        return nearest_;
    }

  private:
    static double room(double t) { return slack * (1 + std::fabs(t)); }

    bool crosses(const Bounds& box, double& t0, double& t1) const {
        for (int k = 0; k < 3; ++k) {
            if (ray_.direction[k] == 0) {
                if (ray_.origin[k] < box.lower[k] || ray_.origin[k] > box.upper[k]) return false;
                continue;
            }
            const double a = (box.lower[k] - ray_.origin[k]) / ray_.direction[k],
                         b = (box.upper[k] - ray_.origin[k]) / ray_.direction[k];
            t0 = std::max(t0, std::min(a, b) - room(a));
            t1 = std::min(t1, std::max(a, b) + room(b));
        }
        return t0 <= t1;
    }

    void test_blocks(std::uint32_t first_triangle, std::uint32_t triangles, std::uint32_t first_sphere,
                     std::uint32_t spheres) {
        const auto of_triangles = static_cast<std::int64_t>(shapes_.triangles.size());
        for (std::uint32_t b = first_triangle; b < first_triangle + triangles; ++b)
            for (const std::int32_t id : hierarchy_.triangle_blocks[b].id)
                if (id >= 0) test(ray_, shapes_.triangles[static_cast<std::size_t>(id)], id, nearest_);
        for (std::uint32_t b = first_sphere; b < first_sphere + spheres; ++b)
            for (const std::int32_t id : hierarchy_.sphere_blocks[b].id)
                if (id >= 0) test(ray_, shapes_.spheres[static_cast<std::size_t>(id)], of_triangles + id, nearest_);
    }

    void visit(const KdTree& tree, std::uint32_t index, double t0, double t1) {
        if (nearest_.t < t0 - room(t0)) return;
        const KdNode node = tree.nodes[index];
        if (node.leaf()) {
            const KdLeaf& leaf = tree.leaves[node.index()];
            test_blocks(leaf.first_triangle_block, leaf.triangle_blocks, leaf.first_sphere_block, leaf.sphere_blocks);
            return;
        }
        const double o = ray_.origin[node.axis()], d = ray_.direction[node.axis()], s = node.split;
        if (d == 0) {  // in the plane: both sides
            if (o <= s) visit(tree, node.index(), t0, t1);
            if (o >= s) visit(tree, node.index() + 1, t0, t1);
            return;
        }
        const double at = (s - o) / d;
        const std::uint32_t near = node.index() + (d < 0), far = node.index() + (d > 0);
        if (at >= t0 - room(at)) visit(tree, near, t0, std::min(t1, at));
        if (at <= t1 + room(at)) visit(tree, far, std::max(t0, at), t1);
    }

    void visit(const Bvh& tree, std::uint32_t index) {
        const BvhNode& node = tree.nodes[index];
        for (int slot = 0; slot < lanes; ++slot) {
            Bounds box;
            for (int k = 0; k < 3; ++k) {
                box.lower[k] = node.lower[k][slot];
                box.upper[k] = node.upper[k][slot];
            }
            double t0 = 0, t1 = nearest_.t;
            if (box.empty() || !crosses(box, t0, t1)) continue;
            const BvhReference child{node.child[slot]};
            if (!child.leaf())
                visit(tree, child.bits);
            else if (child.spheres())
                test_blocks(0, 0, child.first(), child.blocks());
            else
                test_blocks(child.first(), child.blocks(), 0, 0);
        }
    }

    const NaiveRay& ray_;
    const Hierarchy& hierarchy_;
    const Shapes& shapes_;
    NaiveHit nearest_;
};

}  // namespace

NaiveHit nearest_by_loop(const NaiveRay& ray, const Shapes& shapes, double rim) {
    NaiveHit nearest;
    std::int64_t id = 0;
    for (const TriangleCorners& triangle : shapes.triangles) test(ray, triangle, id++, nearest, rim);
    for (const SphereShape& sphere : shapes.spheres) test(ray, sphere, id++, nearest, rim);
    return nearest;
}

NaiveHit nearest_by_tree(const NaiveRay& ray, const Hierarchy& hierarchy, const Shapes& shapes) {
    return Traversal(ray, hierarchy, shapes).nearest();
}

namespace {

// A corner of a triangle, or a point of a sphere on its axes.
glm::vec3 corner(Random& random, const ShapeSet& scene) {
    const std::size_t count = scene.triangles.size() + scene.spheres.size();
    if (count == 0) return random.point(-1, 1);
    const std::size_t i = random.below(count);
    if (i < scene.triangles.size()) return scene.triangles[i].p[random.below(3)];
    const SphereShape& sphere = scene.spheres[i - scene.triangles.size()];
    glm::vec3 p = sphere.center;
    p[static_cast<int>(random.below(3))] += random.below(2) == 0 ? sphere.radius : -sphere.radius;
    return p;
}

// A point of a triangle: inside, on an edge or a corner.
glm::vec3 on_shape(Random& random, const ShapeSet& scene) {
    if (scene.triangles.empty()) return corner(random, scene);
    const TriangleCorners& t = scene.triangles[random.below(scene.triangles.size())];
    const std::uint32_t kind = random.below(4);
    float u = random.between(0, 1), v = random.between(0, 1 - u);
    if (kind == 0) v = 0;
    if (kind == 1) v = 1 - u;
    return t.p[0] * (1 - u - v) + t.p[1] * u + t.p[2] * v;
}

}  // namespace

NaiveRay awkward_ray(Random& random, const ShapeSet& scene) {
    Vector from = vector(corner(random, scene)), to = vector(on_shape(random, scene));
    const double size = std::max({std::fabs(from[0]), std::fabs(from[1]), std::fabs(from[2]), std::fabs(to[0]),
                                  std::fabs(to[1]), std::fabs(to[2]), 1e-35});
    const auto anywhere = [&] {
        const glm::vec3 p = random.point(-1.5f, 1.5f);
        return Vector{p.x * size, p.y * size, p.z * size};
    };
    Vector direction = minus(to, from);
    switch (random.below(8)) {
        case 0:  // anywhere, anyhow
            from = anywhere();
            direction = anywhere();
            break;
        case 1:  // at a shape
            from = anywhere();
            direction = minus(to, from);
            break;
        case 2:  // along an axis, through coordinates of corners
            direction = {0, 0, 0};
            direction[random.below(3)] = random.below(2) == 0 ? 1 : -1;
            break;
        case 3:  // in a plane of a corner's coordinate
            direction = anywhere();
            direction[random.below(3)] = 0;
            break;
        case 4:  // the same from outside
            direction = anywhere();
            direction[random.below(3)] = 0;
            for (int k = 0; k < 3; ++k) from[k] -= 2 * direction[k];
            break;
        case 5:  // from a surface
            from = to;
            direction = anywhere();
            break;
        case 6:  // along an edge
            if (!scene.triangles.empty()) {
                const TriangleCorners& t = scene.triangles[random.below(scene.triangles.size())];
                from = vector(t.p[0]);
                direction = minus(vector(t.p[1]), from);
                for (int k = 0; k < 3; ++k) from[k] -= 0.5 * direction[k];
            }
            break;
        default:  // from a corner to a point of a shape
            break;
    }
    for (double& d : direction) d = std::isfinite(d) ? d : 0;
    for (double& o : from) o = std::isfinite(o) ? o : 0;
    const double norm = length(direction);
    if (!(norm > 0)) return {{from[0], from[1], from[2]}, {0, 0, 1}};
    // Of the scene's size, so that t is about 1 and a fixed slack fits every scale.
    return {{from[0], from[1], from[2]},
            {direction[0] / norm * size, direction[1] / norm * size, direction[2] / norm * size}};
}

}  // namespace raywalk::testing
