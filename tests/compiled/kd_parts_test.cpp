// The pieces of the kd-tree builder, each against its naive twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/oracle/compiled_shapes.h"
#include "tests/support/repetitions.h"
#include "tracer/compiled/kdtree/clip.h"
#include "tracer/compiled/kdtree/event.h"
#include "tracer/compiled/kdtree/node.h"
#include "tracer/compiled/kdtree/sweep.h"
#include "tracer/compiled/shape_bounds.h"

namespace raywalk::kd {
namespace {

using raywalk::testing::Random;

TEST(KdEvent, OrdersLikePositionThenType) {
    const float positions[] = {-3e38f, -1.5f, -1e-40f, 0, 1e-40f, 1, 1.0000001f, 3e38f};
    const EventType types[] = {EventType::end, EventType::planar, EventType::start};
    std::vector<Event> in_order;
    for (const float position : positions)
        for (const EventType type : types) in_order.push_back(make_event(position, type, 5));
    EXPECT_TRUE(std::is_sorted(in_order.begin(), in_order.end()));
    EXPECT_EQ(std::adjacent_find(in_order.begin(), in_order.end()), in_order.end());
    EXPECT_LT(in_order.back(), last_event);
}

TEST(KdEvent, GivesBackWhatItWasMadeOf) {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const float position = std::ldexp(random.between(-1, 1), static_cast<int>(random.below(200)) - 100);
        const auto type = static_cast<EventType>(random.below(3));
        const std::uint32_t slot = random.below(slot_mask + 1);
        const Event event = make_event(position, type, slot);
        EXPECT_EQ(position_of(event), position);
        EXPECT_EQ(type_of(event), type);
        EXPECT_EQ(slot_of(event), slot);
    }
}

TEST(KdEvent, RadixSortAgreesWithComparing) {
    Random random(2);
    for (const std::size_t count : {0u, 1u, 100u, 4096u, 50000u}) {
        std::vector<Event> events(count), scratch(count);
        for (std::size_t i = 0; i < count; ++i)
            events[i] = make_event(std::round(random.between(-99, 99)) / 8, static_cast<EventType>(random.below(3)),
                                   static_cast<std::uint32_t>(i));
        std::vector<Event> expected = events;
        std::sort(expected.begin(), expected.end());  // slots ascend, so that stable sorting gives the same
        sort_events(events, scratch);
        EXPECT_EQ(events, expected);
    }
}

bool contains(const Bounds& box, const glm::dvec3& p, double room) {
    for (int k = 0; k < 3; ++k)
        if (p[k] < box.lower[k] - room || p[k] > box.upper[k] + room) return false;
    return true;
}

bool inside(const Bounds& inner, const Bounds& outer) {
    for (int k = 0; k < 3; ++k)
        if (inner.lower[k] < outer.lower[k] || inner.upper[k] > outer.upper[k]) return false;
    return true;
}

// Splits a shape's box again and again at random planes; each of many points of the shape must stay in the box of the
// part on its side.
template <class Shape, class SplitShape, class Point>
void points_are_never_lost(const Shape& shape, SplitShape split_shape, Point point, Random& random) {
    Bounds box = bounds_of(shape);
    for (int level = 0; level < 12 && !box.empty(); ++level) {
        const int axis = static_cast<int>(random.below(3));
        const float plane = random.between(box.lower[axis], box.upper[axis]);
        if (!(plane > box.lower[axis] && plane < box.upper[axis])) continue;
        const Parts parts = split_shape(shape, box, axis, plane);
        if (!parts.lower.empty()) {
            EXPECT_TRUE(inside(parts.lower, box));
            EXPECT_LE(parts.lower.upper[axis], plane);
        }
        if (!parts.upper.empty()) {
            EXPECT_TRUE(inside(parts.upper, box));
            EXPECT_GE(parts.upper.lower[axis], plane);
        }
        const double rounding = 1e-14 * largest_magnitude(bounds_of(shape));  // of the points below
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 p = point(shape, random);
            if (!contains(box, p, -rounding)) continue;
            if (p[axis] < plane)
                EXPECT_TRUE(contains(parts.lower, p, rounding)) << "level " << level;
            else
                EXPECT_TRUE(contains(parts.upper, p, rounding)) << "level " << level;
        }
        box = random.below(2) == 0 ? parts.lower : parts.upper;
    }
}

TEST(KdClip, LosesNoPointOfATriangle) {
    Random random(3);
    const auto point = [](const TriangleCorners& t, Random& r) {
        double u = r.between(0, 1), v = r.between(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return glm::dvec3(t.p[0]) * (1 - u - v) + glm::dvec3(t.p[1]) * u + glm::dvec3(t.p[2]) * v;
    };
    for (const float scale : {1.0f, 1e-30f, 1e30f, 1e-3f})
        for (TriangleCorners t : raywalk::testing::triangle_soup(4, 300, 1)) {
            const bool sliver = random.below(4) == 0;
            for (glm::vec3& p : t.p) p *= scale;
            if (sliver) t.p[2] = t.p[1] + (t.p[0] - t.p[1]) * 1e-6f;
            points_are_never_lost(t, split_triangle, point, random);
        }
}

TEST(KdClip, LosesNoPointOfASpheresSurface) {
    Random random(5);
    const auto point = [](const SphereShape& s, Random& r) {
        glm::dvec3 d;
        double length;
        do {
            d = r.point(-1, 1);
            length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        } while (length < 0.1);
        return glm::dvec3(s.center) + d * (s.radius / length);
    };
    for (const float scale : {1.0f, 1e-30f, 1e17f})
        for (int i = 0; i < 300; ++i) {
            const SphereShape sphere{random.point(-1, 1) * scale, random.between(0.001f, 2) * scale};
            points_are_never_lost(sphere, split_sphere, point, random);
        }
}

TEST(KdClip, IsPerfectForATriangle) {
    // The lower left half of a square, cut in the middle: above the cut it is half as high.
    const TriangleCorners triangle{{{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}};
    const Parts parts = split_triangle(triangle, bounds_of(triangle), 0, 1);
    EXPECT_EQ(parts.lower, (Bounds{{0, 0, 1}, {1, 2, 1}}));
    EXPECT_EQ(parts.upper.lower, glm::vec3(1, 0, 1));
    EXPECT_EQ(parts.upper.upper.x, 2);
    EXPECT_NEAR(parts.upper.upper.y, 1, 1e-5);
}

TEST(KdClip, IsPerfectInACellThatCutsTheTriangleOnEverySide) {
    // What lies outside the cell must not widen what is left: of the slope from (0, 0) to (4, 4) the lower half of the
    // cell [1, 2]^2 keeps [1, 1.5]^2.
    const TriangleCorners triangle{{{0, 0, 1}, {4, 4, 1}, {4, 4, 3}}};
    const Parts parts = split_triangle(triangle, {{1, 1, 0}, {2, 2, 4}}, 0, 1.5f);
    EXPECT_NEAR(parts.lower.upper.y, 1.5, 1e-5);
    EXPECT_NEAR(parts.upper.lower.y, 1.5, 1e-5);
    EXPECT_EQ(parts.lower.lower.y, 1);
    EXPECT_EQ(parts.upper.upper.y, 2);
    // Where x ends at 2, the upper edge has risen to z = 2 of the 3 that it reaches outside.
    EXPECT_NEAR(parts.upper.upper.z, 2, 1e-5);
    EXPECT_NEAR(parts.lower.upper.z, 1.75, 1e-5);
}

TEST(KdClip, LeavesNothingOfASphereDeepInsideIt) {
    const SphereShape sphere{{0, 0, 0}, 10};
    const Parts parts = split_sphere(sphere, {{-1, -1, -1}, {1, 1, 1}}, 0, 0);
    EXPECT_TRUE(parts.lower.empty());
    EXPECT_TRUE(parts.upper.empty());
}

// Every plane that a box begins or ends at, its cost counted box by box.
Split naive_best(const std::vector<Bounds>& boxes, const Bounds& cell, const KdOptions& options) {
    Split best;
    for (int axis = 0; axis < 3; ++axis)
        for (const Bounds& candidate : boxes)
            for (const float plane : {candidate.lower[axis], candidate.upper[axis]}) {
                if (!(plane > cell.lower[axis] && plane < cell.upper[axis])) continue;
                Bounds lower = cell, upper = cell;
                lower.upper[axis] = upper.lower[axis] = plane;
                std::uint32_t below = 0, above = 0, flat = 0;
                for (const Bounds& box : boxes) {
                    const bool on_plane = box.lower[axis] == plane && box.upper[axis] == plane;
                    flat += on_plane;
                    below += !on_plane && box.lower[axis] < plane;
                    above += !on_plane && box.upper[axis] > plane;
                }
                for (const bool flat_below : {false, true}) {
                    const std::uint32_t b = below + (flat_below ? flat : 0), a = above + (flat_below ? 0 : flat);
                    const double cost = options.traversal_cost +
                                        options.intersection_cost / half_area(cell) *
                                            (half_area(lower) * leaf_cost(b) + half_area(upper) * leaf_cost(a));
                    const double with_bonus = (a == 0 || b == 0 ? options.empty_factor : 1) * cost;
                    if (with_bonus < best.cost) best = {with_bonus, axis, plane, 0};
                }
            }
    return best;
}

TEST(KdSweep, FindsTheCheapestOfAllPlanes) {
    Random random(6);
    for (int trial = 0; trial < test::repetitions(300); ++trial) {
        // Coordinates on a coarse grid in some trials: many events at one position, and flat boxes.
        const bool coarse = trial % 2 == 0;
        std::vector<Bounds> boxes(1 + random.below(trial % 5 == 0 ? 600 : 60));
        Bounds cell;
        for (Bounds& box : boxes) {
            for (int corner = 0; corner < 2; ++corner) {
                glm::vec3 p = random.point(0, 8);
                if (coarse) p = glm::round(p / 2.0f) * 2.0f;
                box.extend(p);
            }
            cell.extend(box);
        }
        if (trial % 3 == 0) cell = with_margin(cell);
        if (half_area(cell) == 0) continue;
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Event> events;
            for (std::uint32_t i = 0; i < boxes.size(); ++i)
                for_each_event(i, boxes[i], axis, [&](Event event) { events.push_back(event); });
            std::sort(events.begin(), events.end());
            const Split split = sweep(events, axis, static_cast<std::uint32_t>(boxes.size()), cell, {});
            if (split.cost < best.cost) best = split;
        }
        const Split expected = naive_best(boxes, cell, {});
        if (!std::isfinite(expected.cost)) {
            EXPECT_FALSE(std::isfinite(best.cost));
            continue;
        }
        EXPECT_NEAR(best.cost, expected.cost, 1e-6 * expected.cost) << "trial " << trial;
    }
}

TEST(KdSweep, DistributesEventsInOrder) {
    Random random(7);
    constexpr std::uint32_t slots = 500;
    std::vector<Event> events, fresh[2];
    std::vector<std::uint32_t> target(slots);
    std::size_t expected[2] = {0, 0};
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        constexpr std::uint32_t sides[] = {to_lower, to_upper, straddles};
        const std::uint32_t side = sides[random.below(3)];
        target[slot] = side == straddles ? 0 : side | slot;
        const float a = random.between(0, 1), b = a + random.between(0, 1);
        for (const Event event : {make_event(a, EventType::start, slot), make_event(b, EventType::end, slot)}) {
            events.push_back(event);
            if (side != straddles) ++expected[side == to_upper];
            if (side != straddles) continue;
            for (auto& list : fresh) list.push_back(event);
            ++expected[0], ++expected[1];
        }
    }
    std::sort(events.begin(), events.end());
    for (auto& list : fresh) {
        std::sort(list.begin(), list.end());
        list.push_back(last_event);
    }
    std::vector<Event> lower(events.size() + 1), upper(events.size() + 1);
    const Distributed written =
        distribute(events, target.data(), fresh[0].data(), fresh[1].data(), lower.data(), upper.data());
    ASSERT_EQ(written.lower, expected[0]);
    ASSERT_EQ(written.upper, expected[1]);
    lower.resize(written.lower);
    upper.resize(written.upper);
    EXPECT_TRUE(std::is_sorted(lower.begin(), lower.end()));
    EXPECT_TRUE(std::is_sorted(upper.begin(), upper.end()));
}

}  // namespace
}  // namespace raywalk::kd
