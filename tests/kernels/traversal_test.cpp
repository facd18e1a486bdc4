// Traversal against a loop over all shapes in double precision, on every instruction set and both hierarchies.
#include <gtest/gtest.h>

#include <bit>

#include "tests/kernels/traversal_scenes.h"
#include "tests/support/repetitions.h"

namespace raywalk::traversal_test {
namespace {

// The loop over all shapes. A float tracer may be right in two ways where a ray passes within rounding of an edge, so
// the answer is an interval: the nearest hit for certain, and every hit that is possible.
struct Answer {
    double certain = std::numeric_limits<double>::infinity();  // nearest t of a shape hit well inside its edge
    std::vector<double> possible;                              // every t of a shape hit, edges included
    std::vector<const TriangleCorners*> slivers;               // ill-conditioned: hit or not, but only where they are
};

// How far a point is from the longest edge of a triangle.
double distance_to_longest_edge(const TriangleCorners& triangle, glm::dvec3 point) {
    glm::dvec3 a = triangle.p[0], b = triangle.p[1];
    for (int i = 1; i < 3; ++i) {
        const glm::dvec3 c = triangle.p[i], d = triangle.p[(i + 1) % 3];
        if (glm::length(d - c) > glm::length(b - a)) a = c, b = d;
    }
    const double squared = glm::dot(b - a, b - a);
    const double s = squared > 0 ? std::clamp(glm::dot(point - a, b - a) / squared, 0.0, 1.0) : 0;
    return glm::length(point - (a + s * (b - a)));
}

// How far from the longest edge of a sliver a hit of it may be found. Without fused multiply-add the normal, a cross
// product of edges, is off by a few e |edge| |edge|, which turns the plane about a corner; what that moves the hit is
// the more, the less the ray goes along the true normal. No rounding makes a hit far away of it.
double distance_in_doubt(const TriangleCorners& triangle, glm::dvec3 direction) {
    const glm::dvec3 e1 = triangle.p[1] - triangle.p[0], e2 = triangle.p[2] - triangle.p[0];
    const glm::dvec3 normal = glm::cross(e1, e2);
    const double edges = glm::length(e1) + glm::length(e2), thickness = glm::length(normal) / (edges + 1e-30);
    const double across = std::fabs(glm::dot(normal, glm::normalize(direction)));
    const double turned = 4 * 6e-8 * edges * glm::length(e1) * glm::length(e2) / (across + 1e-30);
    return 4 * thickness + std::clamp(turned, 5e-2, 0.5);
}

constexpr double edge_doubt = 3e-5;

void consider(Answer& answer, const ExactHit& hit, double t_max) {
    const double doubt = 1e-5 * std::max(1.0, std::fabs(hit.t));
    if (!(hit.t > -doubt) || !(hit.t < t_max + doubt) || !(hit.margin > -edge_doubt)) return;
    answer.possible.push_back(hit.t);
    if (hit.margin > edge_doubt && hit.t > doubt && hit.t < t_max - doubt)
        answer.certain = std::min(answer.certain, hit.t);
}

Answer naive_answer(const ShapeSet& set, glm::dvec3 o, glm::dvec3 d, double t_max) {
    Answer answer;
    for (const TriangleCorners& triangle : set.triangles) {
        const ExactHit hit = exact_triangle(triangle, o, d);
        // A sliver, or a ray that grazes: rounding moves the hit along the ray by more than the weights say.
        const glm::dvec3 e1 = triangle.p[1] - triangle.p[0], e2 = triangle.p[2] - triangle.p[0];
        const double longest = std::max({glm::length(e1), glm::length(e2), glm::length(e1 - e2)});
        const glm::dvec3 normal = glm::cross(e1, e2) / (longest * longest + 1e-300);
        if (glm::length(normal) < 1e-3 || std::fabs(glm::dot(normal, d)) < 1e-3 * glm::length(d)) {
            answer.slivers.push_back(&triangle);
            continue;
        }
        consider(answer, hit, t_max);
    }
    for (const SphereShape& sphere : set.spheres) {
        consider(answer, exact_sphere(sphere, o, d, false), t_max);
        consider(answer, exact_sphere(sphere, o, d, true), t_max);
    }
    for (const PlaneRecord& plane : set.planes) consider(answer, exact_plane(plane, o, d), t_max);
    return answer;
}

// Rays of one common origin, so that both doors may take them; `narrow`: as from pixels of a picture.
RayBlocks rays_from(glm::vec3 origin, std::size_t count, Random& random, bool narrow) {
    RayBlocks rays(count);
    glm::vec3 direction = random.direction();
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 64 == 0) direction = random.direction();
        glm::vec3 d = narrow ? direction + random.point(0.04f) : random.direction();
        if (!narrow) d *= random.between(0.2f, 3.0f);  // a statement of its own: every compiler draws in this order
        if (i % 16 == 3) d[i / 16 % 3] = 0;            // in the plane of an axis
        if (i % 64 == 7) d = {0, 0, 0}, d[i / 64 % 3] = i % 128 < 64 ? 1.0f : -1.0f;  // along an axis
        for (int a = 0; a < 3; ++a) rays.origin(a, i) = origin[a], rays.direction(a, i) = d[a];
        if (i % 5 == 4) rays.t_max(i) = random.between(0.5f, 15.0f);
    }
    return rays;
}

glm::vec3 origin_in(const ShapeSet& set, int i, Random& random) {
    const glm::vec3 middle = set.name == "far from the origin" ? glm::vec3(3000) : glm::vec3(0);
    if (i == 0) return middle + glm::vec3(0.25f, 0.5f, 0.125f);
    if (i == 1 && !set.triangles.empty()) {
        const auto& p = set.triangles[set.triangles.size() / 2].p;  // on a surface
        return (p[0] + p[1] + p[2]) / 3.0f;
    }
    if (i == 2 && !set.triangles.empty()) return set.triangles.front().p[1];                          // at a corner
    if (i == 3 && !set.spheres.empty()) return set.spheres[0].center + 0.5f * set.spheres[0].radius;  // inside
    return middle + random.point(i % 2 == 0 ? 5.0f : 25.0f);
}

struct Case {
    Accelerator accelerator;
    const Kernels* kernels;
};

class Traversal : public testing::TestWithParam<Case> {};

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const Accelerator accelerator : {Accelerator::kdtree, Accelerator::bvh})
        for (const Kernels* kernels : available_kernels()) cases.push_back({accelerator, kernels});
    return cases;
}

void check_hits(const ShapeSet& set, const RayBlocks& rays, const HitBlocks& hits, const std::vector<Answer>& answers) {
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Answer& answer = answers[i];
        if (hits.id(i) < 0) {
            wrong += answer.certain < std::numeric_limits<double>::infinity();
            continue;
        }
        const double t = hits.t(i), doubt = 2e-4 * std::max(1.0, std::fabs(t));
        const glm::dvec3 direction = {rays.direction(0, i), rays.direction(1, i), rays.direction(2, i)};
        const glm::dvec3 point = glm::dvec3(rays.origin(0, i), rays.origin(1, i), rays.origin(2, i)) + t * direction;
        const bool exists =
            std::ranges::any_of(answer.possible, [&](double p) { return std::fabs(p - t) < doubt; }) ||
            std::ranges::any_of(answer.slivers, [&](const TriangleCorners* triangle) {
                return distance_to_longest_edge(*triangle, point) < distance_in_doubt(*triangle, direction);
            });
        wrong += !exists || t > answer.certain + doubt;
    }
    EXPECT_EQ(wrong, 0) << "of " << rays.size() << " rays in " << set.name;
}

TEST_P(Traversal, FindsTheHitsThatALoopOverAllShapesFinds) {
    const auto [accelerator, kernels] = GetParam();
    for (const ShapeSet& set : all_shape_sets()) {
        const CompiledScene scene = compile_shapes(set, accelerator);
        Random random(7);
        for (int origin = 0; origin < 4; ++origin) {
            const RayBlocks rays =
                rays_from(origin_in(set, origin, random), test::repetitions(256), random, origin % 2 == 0);
            std::vector<Answer> answers(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i)
                answers[i] =
                    naive_answer(set, {rays.origin(0, i), rays.origin(1, i), rays.origin(2, i)},
                                 {rays.direction(0, i), rays.direction(1, i), rays.direction(2, i)}, rays.t_max(i));
            HitBlocks single(rays.size()), beam(rays.size()), blocked(rays.size()), beam_blocked(rays.size());
            kernels->intersect(scene, rays, single);
            kernels->intersect_beam(scene, rays, beam);
            check_hits(set, rays, single, answers);
            check_hits(set, rays, beam, answers);
            kernels->occluded(scene, rays, blocked);
            kernels->occluded_beam(scene, rays, beam_blocked);
            int disagree = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                disagree += (blocked.id(i) == 0) != (single.id(i) >= 0);
                disagree += (beam_blocked.id(i) == 0) != (beam.id(i) >= 0);
            }
            EXPECT_EQ(disagree, 0) << "any hit against nearest hit in " << set.name;
        }
    }
}

// Rays at every corner and at points on every edge of a closed mesh, exactly where a crack would be.
RayBlocks rays_at_edges(const ShapeSet& set, glm::vec3 origin, Random& random) {
    RayBlocks rays(2 * set.triangles.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto& p = set.triangles[i / 2].p;
        const float s = i % 2 == 0 ? 1.0f : random.between(0, 1);
        const glm::vec3 target = p[0] * s + p[1] * (1 - s);
        for (int a = 0; a < 3; ++a) rays.origin(a, i) = origin[a], rays.direction(a, i) = target[a] - origin[a];
    }
    return rays;
}

int misses(const HitBlocks& hits) {
    int missed = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) missed += hits.id(i) < 0;
    return missed;
}

TEST_P(Traversal, LetsNoRayOutOfAClosedMesh) {
    const auto [accelerator, kernels] = GetParam();
    Random random(8);
    const auto check = [&, kernels = kernels](const ShapeSet& set, const CompiledScene& scene, glm::vec3 origin) {
        const RayBlocks rays = rays_at_edges(set, origin, random);
        HitBlocks hits(rays.size());
        kernels->intersect(scene, rays, hits);
        EXPECT_EQ(misses(hits), 0) << "single rays";
        kernels->intersect_beam(scene, rays, hits);
        EXPECT_EQ(misses(hits), 0) << "beams";
    };
    const ShapeSet set{.name = "closed", .triangles = icosphere(4)};
    const CompiledScene scene = compile_shapes(set, accelerator);
    for (const glm::vec3 origin : {glm::vec3(0), glm::vec3(0.3f, -0.2f, 0.5f), glm::vec3(-0.7f, 0.1f, 0.1f)})
        check(set, scene, origin);
    // Triangles as fine as coordinates allow for: a hundred-thousandth of their distance.
    ShapeSet fine{.name = "closed, small and far", .triangles = icosphere(3)};
    for (TriangleCorners& triangle : fine.triangles)
        for (glm::vec3& p : triangle.p) p = p * 0.01f + glm::vec3(5, 3, -4);
    const CompiledScene fine_scene = compile_shapes(fine, accelerator);
    check(fine, fine_scene, glm::vec3(5, 3, -4));
    // From far away through the middle: what enters has to meet the far side at the latest.
    const RayBlocks rays = rays_at_edges(fine, {0, 0, 0}, random);
    RayBlocks inner = rays;
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (int a = 0; a < 3; ++a) inner.direction(a, i) = 0.8f * rays.direction(a, i) + 0.2f * glm::vec3(5, 3, -4)[a];
    HitBlocks hits(rays.size());
    kernels->intersect(fine_scene, inner, hits);
    EXPECT_EQ(misses(hits), 0) << "from far away";
}

INSTANTIATE_TEST_SUITE_P(AllKernels, Traversal, testing::ValuesIn(all_cases()), [](const auto& named) {
    return std::string(named.param.accelerator == Accelerator::bvh ? "Bvh_" : "KdTree_") +
           std::string(named.param.kernels->name);
});

void expect_same_bits(const HitBlocks& a, const HitBlocks& b, const std::string& what) {
    int differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        differ += a.id(i) != b.id(i) || std::bit_cast<std::uint32_t>(a.t(i)) != std::bit_cast<std::uint32_t>(b.t(i)) ||
                  (a.id(i) >= 0 && (a.u(i) != b.u(i) || a.v(i) != b.v(i)));
    EXPECT_EQ(differ, 0) << what;
}

// Both hierarchies, and the instruction sets that round alike, agree to the last bit.
TEST(TraversalBits, AreTheSameForBothHierarchiesAndEqualRounding) {
    for (const ShapeSet& set : all_shape_sets()) {
        const CompiledScene kd = compile_shapes(set, Accelerator::kdtree), bvh = compile_shapes(set, Accelerator::bvh);
        Random random(9);
        for (int origin = 0; origin < 6; ++origin) {
            const RayBlocks rays =
                rays_from(origin_in(set, origin, random), test::repetitions(2048), random, origin % 2 == 0);
            std::vector<HitBlocks> of_kernels;
            for (const Kernels* kernels : available_kernels()) {
                HitBlocks single(rays.size()), beam(rays.size()), other(rays.size());
                kernels->intersect(kd, rays, single);
                kernels->intersect(bvh, rays, other);
                expect_same_bits(single, other, "single rays, kd-tree against BVH, " + set.name);
                kernels->intersect_beam(kd, rays, beam);
                kernels->intersect_beam(bvh, rays, other);
                expect_same_bits(beam, other, "beams, kd-tree against BVH, " + set.name);
                expect_same_bits(single, beam, "single rays against beams, " + set.name);
                of_kernels.push_back(single);
                of_kernels.push_back(beam);
            }
            // Fused (avx512, avx2) and not fused (sse4, scalar) come in this order, best first.
            const auto kernels = available_kernels();
            const auto fused = [](const Kernels* k) { return k->name == "avx512" || k->name == "avx2"; };
            for (std::size_t i = 0; i + 1 < kernels.size(); ++i)
                for (std::size_t door = 0; door < 2 && fused(kernels[i]) == fused(kernels[i + 1]); ++door)
                    expect_same_bits(of_kernels[2 * i + door], of_kernels[2 * i + 2 + door],
                                     std::string(kernels[i]->name) + " against the next, " + set.name);
        }
    }
}

// A ray hits the same alone, among others, and in whatever order they come.
TEST(TraversalBits, DoNotDependOnTheCompanyOfARay) {
    for (const ShapeSet& set : all_shape_sets()) {
        const CompiledScene scene = compile_shapes(set, Accelerator::bvh);
        Random random(10);
        RayBlocks rays(256);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::vec3 origin = origin_in(set, static_cast<int>(i % 8), random), direction = random.direction();
            for (int a = 0; a < 3; ++a) rays.origin(a, i) = origin[a], rays.direction(a, i) = direction[a];
        }
        for (const Kernels* kernels : available_kernels()) {
            HitBlocks together(rays.size()), shuffled(rays.size()), alone(rays.size());
            kernels->intersect(scene, rays, together);
            const auto copy_ray = [&](std::size_t from, RayBlocks& to, std::size_t i) {
                for (int a = 0; a < 3; ++a)
                    to.origin(a, i) = rays.origin(a, from), to.direction(a, i) = rays.direction(a, from);
            };
            const auto place = [&](std::size_t i) { return (i * 37 + 11) % rays.size(); };  // a permutation
            RayBlocks others(rays.size());
            HitBlocks found(rays.size());
            for (std::size_t i = 0; i < rays.size(); ++i) copy_ray(i, others, place(i));
            kernels->intersect(scene, others, found);
            for (std::size_t i = 0; i < rays.size(); ++i) shuffled.set(i, found.hit(place(i)));
            expect_same_bits(together, shuffled, "in another order, " + set.name);
            RayBlocks one(1);
            HitBlocks own(1);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                copy_ray(i, one, 0);
                kernels->intersect(scene, one, own);
                alone.set(i, own.hit(0));
            }
            expect_same_bits(together, alone, "alone, " + set.name);
        }
    }
}

}  // namespace
}  // namespace raywalk::traversal_test
