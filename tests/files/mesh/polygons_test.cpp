// Polygons of any shape become triangles that fill them.
#include "tracer/files/mesh/polygons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/files/mesh/obj_text.h"
#include "tracer/files/mesh/ear_clipping.h"

namespace raywalk {
namespace {

using Ring = std::vector<glm::vec2>;

double cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

double twice_area_of(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 2; i < ring.size(); ++i) sum += cross(ring[0], ring[i - 1], ring[i]);
    return sum;
}

// As a face of an OBJ file, seen along some axis.
std::string text_of(const Ring& ring, int axis = 2) {
    std::string text, face = "f";
    for (std::size_t i = 0; i < ring.size(); ++i) {
        glm::vec3 p(0.25f);
        p[(axis + 1) % 3] = ring[i].x;
        p[(axis + 2) % 3] = ring[i].y;
        char line[100];
        std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", double{p.x}, double{p.y}, double{p.z});
        text += line;
        face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
}

// The triangles are wound as the ring, and their areas add up to its own: they fill it, and nothing else, once.
void expect_filled(const Ring& ring, int axis = 2) {
    const TriangleMesh mesh = triangles_of(text_of(ring, axis));
    ASSERT_EQ(mesh.faces.size(), ring.size() - 2);
    const double whole = twice_area_of(ring);
    double sum = 0, least = 0;
    for (const Corners& face : mesh.faces) {
        const double area = cross(ring[face[0]], ring[face[1]], ring[face[2]]) * (whole < 0 ? -1 : 1);
        sum += area;
        least = std::min(least, area);
    }
    EXPECT_NEAR(sum, std::abs(whole), 1e-9 * std::abs(whole));
    EXPECT_GE(least, -1e-6 * std::abs(whole)) << ring.size() << " corners";
}

// From every corner, both ways round, in every plane.
void expect_filled_however_written(Ring ring) {
    for (int reversed = 0; reversed < 2; ++reversed, std::ranges::reverse(ring))
        for (std::size_t first = 0; first < ring.size(); ++first) {
            expect_filled(ring, static_cast<int>(first % 3));
            std::rotate(ring.begin(), ring.begin() + 1, ring.end());
        }
}

const Ring letter_c = {{-1, -1}, {1, -1}, {1, -.5f}, {-.5f, -.5f}, {-.5f, .5f}, {1, .5f}, {1, 1}, {-1, 1}};

TEST(Polygons, ConcaveOnesAreFilled) {
    expect_filled_however_written(letter_c);
    expect_filled_however_written({{0, 0}, {4, 0}, {1, 1}, {0, 4}});                  // a dart
    expect_filled_however_written({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}});  // an L
    expect_filled_however_written(
        {{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2}, {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}});
}

TEST(Polygons, CornersInALineDoNoHarm) {
    expect_filled_however_written({{-1, -1},
                                   {0, -1},
                                   {1, -1},
                                   {1, -.75f},
                                   {1, -.5f},
                                   {0, -.5f},
                                   {-.5f, -.5f},
                                   {-.5f, 0},
                                   {-.5f, .5f},
                                   {.5f, .5f},
                                   {1, .5f},
                                   {1, 1},
                                   {-1, 1},
                                   {-1, .5f}});
    expect_filled_however_written({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 1}, {1, 3}, {0, 3}, {0, 2}});
}

// A hole, reached by an edge there and back; holes that share a bridge; a spike; corners given twice; two squares that
// meet in a corner.
TEST(Polygons, ThoseThatTouchThemselvesAreFilled) {
    expect_filled_however_written({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}});
    expect_filled_however_written({{0, 0},
                                   {5, 0},
                                   {5, 3},
                                   {0, 3},
                                   {0, 0},
                                   {1, 1},
                                   {1, 2},
                                   {2, 2},
                                   {2, 1},
                                   {3, 1},
                                   {3, 2},
                                   {4, 2},
                                   {4, 1},
                                   {3, 1},
                                   {2, 1},
                                   {1, 1}});
    expect_filled_however_written({{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}, {0, 1}});
    expect_filled_however_written({{0, 0}, {4, 0}, {4, 0}, {1, 1}, {1, 1}, {1, 1}, {0, 4}});
    expect_filled_however_written({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}});
}

// The way around all walls of a maze of unit cells: each wall between two cells is walked along on both of its sides.
class Maze {
  public:
    Maze(unsigned seed, int size)
        : random_(seed), size_(size), seen_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {
        visit({0, 0}, 3, 4);
    }
    [[nodiscard]] const Ring& walls() const { return walls_; }

  private:
    // Sides of a cell, counter-clockwise: to the neighbour, and where its wall starts.
    static constexpr glm::ivec2 towards[] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    static constexpr glm::ivec2 starts[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    [[nodiscard]] std::size_t index(glm::ivec2 cell) const {
        return static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(cell.x);
    }
    void visit(glm::ivec2 cell, int entered, int sides) {
        seen_[index(cell)] = true;
        for (int i = 1; i <= sides; ++i) {
            const int side = (entered + i) % 4;
            const glm::ivec2 next = cell + towards[side];
            const bool inside = std::min(next.x, next.y) >= 0 && std::max(next.x, next.y) < size_;
            if (inside && !seen_[index(next)] && random_() % 4 != 0)
                visit(next, (side + 2) % 4, 3);
            else
                walls_.emplace_back(cell + starts[side]);
        }
    }

    std::mt19937 random_;
    int size_;
    std::vector<bool> seen_;
    Ring walls_;
};

TEST(Polygons, MazesAreFilled) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Ring walls = Maze(seed, 2 + static_cast<int>(seed % 9)).walls();
        if (seed % 2 != 0) std::ranges::reverse(walls);
        std::rotate(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(seed % walls.size()), walls.end());
        expect_filled(walls, static_cast<int>(seed % 3));
    }
    expect_filled(Maze(1, 40).walls());
}

// Rays of random lengths, or a walk there and back along a spiral; with the first corner anywhere.
Ring star(unsigned seed, std::size_t corners) {
    std::mt19937 random(seed);
    Ring ring;
    for (std::size_t i = 0; i < corners; ++i) {
        const double turn = 2 * M_PI * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = 0.1 + static_cast<double>(random()) / 4294967296.0;
        ring.emplace_back(radius * std::cos(turn), radius * std::sin(turn));
    }
    return ring;
}

Ring spiral(std::size_t corners) {
    Ring ring;
    for (std::size_t i = 0; i < corners; ++i) {
        const bool back = i >= corners / 2;
        const auto along = static_cast<double>(back ? corners - 1 - i : i) / static_cast<double>(corners);
        const double turn = 30 * along, radius = (back ? 0.97 : 1.0) * (0.2 + along);
        ring.emplace_back(radius * std::cos(turn), radius * std::sin(turn));
    }
    return ring;
}

Ring comb(std::size_t corners) {
    Ring ring = {{static_cast<float>(corners), -1}, {static_cast<float>(corners), 0}};
    for (std::size_t i = corners - 1; ring.size() < corners - 1; --i)
        ring.emplace_back(static_cast<float>(i), i % 2 ? 0.0f : 100.0f);
    ring.emplace_back(ring.back().x - 1, -1.0f);
    return ring;
}

TEST(Polygons, OnesOfManyCornersAreFilled) {
    for (unsigned seed = 0; seed < 100; ++seed) expect_filled(star(seed, 4 + seed));
    for (const std::size_t corners : {10u, 100u, 1000u, 20'000u}) {
        expect_filled(star(1, corners));
        expect_filled(spiral(corners));
        expect_filled(comb(corners));
    }
}

TEST(Polygons, ThatCrossThemselvesBecomeAsManyTriangles) {
    std::mt19937 random(2);
    for (std::size_t corners = 4; corners < 60; ++corners) {
        Ring ring;
        for (std::size_t i = 0; i < corners; ++i) ring.emplace_back(random() % 8, random() % 8);
        EXPECT_EQ(triangles_of(text_of(ring)).faces.size(), corners - 2);
    }
    EXPECT_EQ(triangles_of("v 0 0 0\nv 0 0 0\nv 1 0 0\nf 1 2 3 1 2\n").faces.size(), 3u);
}

TEST(Polygons, ConvexOnesKeepTheirFan) {
    Ring round;
    for (int i = 0; i < 100; ++i) round.emplace_back(std::cos(0.06 * i), std::sin(0.06 * i));
    // Corners in a line, rounded to either side of it.
    const Ring lined = {{0.1f, 0.1f}, {0.4f, 0.2f}, {0.7f, 0.3f}, {1.0f, 0.4f}, {1.3f, 0.5f}, {0.2f, 0.9f}};
    for (const Ring& ring : {round, lined}) {
        const auto faces = triangles_of(text_of(ring)).faces;
        for (std::uint32_t i = 0; i < faces.size(); ++i) EXPECT_EQ(faces[i], (Corners{0, i + 1, i + 2}));
    }
}

TEST(Polygons, NormalsFollowTheirCorners) {
    std::string text = text_of(letter_c);
    text.resize(text.find('f'));
    for (int i = 0; i < 8; ++i) text += "vn 0 " + std::to_string(i) + " 1\n";
    text += "f 1//1 2//2 3//3 4 5//5 6//6 7//7 8//8\nf 1 2 3\n";
    const TriangleMesh mesh = triangles_of(text);
    for (std::size_t f = 0; f < 6; ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t vertex = mesh.faces[f][i];
            EXPECT_EQ(mesh.normal_faces[f][i], vertex == 3 ? -1 : static_cast<std::int32_t>(vertex));
        }
    EXPECT_NE(mesh.faces[1], (Corners{0, 2, 3}));  // no fan
}

// A polygon among others, in a later piece of the text than its vertices.
TEST(Polygons, AreFoundAmongOthers) {
    std::string text = text_of(letter_c);
    const std::string concave = text.substr(text.find('f'));
    while (text.size() < 2u << 20) text += "f 1 2 7 8\nf 1 2 3\n";
    const std::size_t before = triangles_of(text).faces.size();
    const TriangleMesh mesh = triangles_of(text + concave + "f 1 2 7 8\n");
    double area = 0;
    for (std::size_t f = before; f < before + 6; ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        area += std::abs(cross(letter_c[a], letter_c[b], letter_c[c]));
    }
    EXPECT_NEAR(area, twice_area_of(letter_c), 1e-6);
    EXPECT_EQ(mesh.faces[before + 6], (Corners{0, 1, 6}));
}

TEST(Polygons, WorkGrowsAsTheSquareOfTheCornersAtWorst) {
    const auto is_cut = [](const Ring& ring, std::uint64_t steps) {
        std::vector<glm::vec3> corners;
        for (const glm::vec2& p : ring) corners.emplace_back(p, 0);
        return !EarClipper(steps).cut(corners).empty();
    };
    for (const std::size_t n : {100u, 1000u}) {
        EXPECT_TRUE(is_cut(comb(n), 10 * n * n));
        EXPECT_TRUE(is_cut(star(3, n), 10 * n * n));
        EXPECT_TRUE(is_cut(spiral(n), 10 * n * n));
    }
    EXPECT_TRUE(is_cut(comb(20'000), 100 * 20'000));
    EXPECT_FALSE(is_cut(comb(1000), 1000));  // and not one step more than there are
}

}  // namespace
}  // namespace raywalk
