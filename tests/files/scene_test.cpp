#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <span>

#include "tests/files/folder.h"
#include "tests/files/scene_text.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk {
namespace {

// --- a random scene, printed and parsed back ---

struct Named {
    std::string_view name;
    glm::dvec3 color;
};
constexpr Named colors[] = {{"WHITE", {1, 1, 1}}, {"BLACK", {0, 0, 0}},  {"RED", {1, 0, 0}},  {"GREEN", {0, 1, 0}},
                            {"BLUE", {0, 0, 1}},  {"YELLOW", {1, 1, 0}}, {"CYAN", {0, 1, 1}}, {"MAGENTA", {1, 0, 1}}};

class RandomScene {
  public:
    explicit RandomScene(unsigned seed) : random_(seed) {}

    // Below maximum.
    int below(int maximum) { return std::uniform_int_distribution<int>(0, maximum - 1)(random_); }
    // Of any size from 1e-9 to 1e11, with a sign if wanted.
    double number(bool positive) {
        const double v = std::pow(10.0, std::uniform_real_distribution<double>(-9, 11)(random_));
        return positive || below(2) ? v : -v;
    }
    glm::dvec3 vector() { return {number(false), number(false), number(false)}; }
    const Named& color() { return colors[below(std::size(colors))]; }

    Texture texture(bool pure) {
        Texture t;
        t.material = materials[below(std::size(materials))];
        switch (pure ? 0 : below(3)) {
            case 0:
                t.pattern = PureTexture{color().color};
                break;
            case 1:
                t.pattern = GridTexture{1 + below(1000)};
                break;
            default:
                t.pattern = ImageTexture{"objs/a file.bin", below(2) ? 4 : 1 + below(100), {}};
        }
        return t;
    }

    Scene scene() {
        Scene s;
        Viewer& v = s.viewer;
        v.width = 1 + below(16384);
        v.height = 1 + below(16384);
        if (below(2)) v.viewport = glm::dvec2(1 + below(100), 1 + below(100));
        v.center = vector();
        v.target = vector();
        const glm::dvec3 forward = glm::normalize(v.target - v.center);
        v.up = glm::abs(forward.y) < 0.9 ? glm::dvec3(0, 3, 0) : glm::dvec3(0, 0, -2e-6);
        v.fovy_degrees = std::uniform_real_distribution<double>(1, 179)(random_);
        if (below(2)) v.depth_of_field = DepthOfField{below(2) ? 0 : number(true), number(true), 1 + below(100)};
        if (below(2)) v.antialiasing = 1 + below(100);
        for (int i = below(4); i > 0; --i) {
            Light l{vector(), color().color, number(true), {}};
            if (below(2)) l.area = AreaSpread{1 + below(40), below(2) ? 0 : number(true)};
            s.lights.push_back(l);
        }
        for (int i = below(4); i > 0; --i) s.planes.push_back({texture(false), vector(), number(false)});
        constexpr double indices[] = {1.0, 1.333, 1.5};
        for (int i = below(5); i > 0; --i)
            s.spheres.push_back({texture(false), vector(), number(true), indices[below(3)]});
        for (int i = below(4); i > 0; --i) s.faces.push_back({texture(true), vector(), vector(), vector()});
        for (int i = below(4); i > 0; --i)
            s.meshes.push_back({texture(true), "objs/a file.bin", {}, vector(), number(true), below(2) == 1});
        return s;
    }

    // The scene as text: properties in any order, with blanks, tabs, comments and blank lines between them.
    std::string print(const Scene& s);

  private:
    std::string blank() {
        constexpr std::string_view blanks[] = {" ", "\t", "   ", " \t "};
        return std::string(blanks[below(4)]);
    }
    std::string text(double v) {
        char buffer[64];
        return {buffer, std::to_chars(buffer, buffer + 64, v).ptr};
    }
    std::string text(const glm::dvec3& v) { return text(v.x) + blank() + text(v.y) + blank() + text(v.z); }
    std::string_view color_name(const glm::dvec3& c) { return std::ranges::find(colors, c, &Named::color)->name; }
    std::string text(const Texture& t) {
        const std::string m = blank() + std::string(t.material.name) + blank();
        if (const auto* pure = std::get_if<PureTexture>(&t.pattern))
            return "PureTexture" + m + std::string(color_name(pure->color));
        if (const auto* grid = std::get_if<GridTexture>(&t.pattern))
            return "GridTexture" + m + std::to_string(grid->density);
        const auto& image = std::get<ImageTexture>(t.pattern);
        const std::string size = image.size == 4 && below(2) ? "" : blank() + std::to_string(image.size);
        return "ImageTexture" + m + '"' + image.file.string() + '"' + size;
    }
    std::string block(std::string_view name, std::vector<std::pair<std::string, std::string>> properties) {
        std::ranges::shuffle(properties, random_);
        std::string result = std::string(name) + (below(2) ? "\n" : " \t\r\n");
        for (const auto& [property, value] : properties) {
            if (below(4) == 0) result += below(2) ? "\n \n" : "  # " + property + " of something else\n";
            if (below(2)) result += blank();
            result.append(property).append(blank()).append(value);
            result += below(2) ? "\n" : blank() + "\r\n";
        }
        return result;
    }

    std::mt19937 random_;
};

std::string RandomScene::print(const Scene& s) {
    std::vector<std::string> blocks;
    std::vector<std::pair<std::string, std::string>> p = {
        {"geo", std::to_string(s.viewer.width) + blank() + std::to_string(s.viewer.height)},
        {"center", text(s.viewer.center)},
        {"target", text(s.viewer.target)},
        {"up", text(s.viewer.up)},
        {"fovy", text(s.viewer.fovy_degrees)}};
    if (s.viewer.viewport) p.emplace_back("view", text(s.viewer.viewport->x) + blank() + text(s.viewer.viewport->y));
    if (const auto& d = s.viewer.depth_of_field)
        p.emplace_back(
            "dop", text(d->aperture_radius) + blank() + text(d->focal_distance) + blank() + std::to_string(d->samples));
    if (s.viewer.antialiasing) p.emplace_back("anti", std::to_string(*s.viewer.antialiasing));
    std::string result = below(2) ? "\xEF\xBB\xBF" : "";
    result += block("Viewer", p);
    for (const Light& l : s.lights) {
        p = {{"origin", text(l.origin)}, {"color", std::string(color_name(l.color))}, {"intensity", text(l.intensity)}};
        if (l.area) p.emplace_back("area", std::to_string(l.area->n) + blank() + text(l.area->radius));
        result += block("Light", p);
    }
    for (const Plane& o : s.planes)
        result +=
            block("Plane", {{"texture", text(o.texture)}, {"normal", text(o.normal)}, {"offset", text(o.offset)}});
    for (const Sphere& o : s.spheres) {
        p = {{"texture", text(o.texture)}, {"center", text(o.center)}, {"radius", text(o.radius)}};
        const std::string index = o.refraction_index == 1.5     ? "GLASS_REFRACTION_INDEX"
                                  : o.refraction_index == 1.333 ? "WATER_REFRACTION_INDEX"
                                                                : "VACUUM_REFRACTION_INDEX";
        if (o.refraction_index != 1 || below(2)) p.emplace_back("refraction_index", index);
        result += block("Sphere", p);
    }
    for (const Face& o : s.faces)
        result += block("Face", {{"texture", text(o.texture)}, {"a", text(o.a)}, {"b", text(o.b)}, {"c", text(o.c)}});
    for (const Mesh& o : s.meshes) {
        p = {{"texture", text(o.texture)},
             {"file", '"' + o.file.string() + '"'},
             {"center", text(o.center)},
             {"radius", text(o.radius)}};
        if (o.smooth || below(2)) p.emplace_back("smooth", o.smooth ? below(2) ? "true" : "True" : "False");
        result += block("Mesh", p);
    }
    if (below(2)) result.resize(result.find_last_not_of(" \t\r\n") + 1);  // no last line end
    return result;
}

void expect_same(const Texture& a, const Texture& b, const fs::path& folder) {
    EXPECT_EQ(a.material.name, b.material.name);
    ASSERT_EQ(a.pattern.index(), b.pattern.index());
    if (const auto* pure = std::get_if<PureTexture>(&a.pattern)) {
        EXPECT_EQ(pure->color, std::get<PureTexture>(b.pattern).color);
    } else if (const auto* grid = std::get_if<GridTexture>(&a.pattern)) {
        EXPECT_EQ(grid->density, std::get<GridTexture>(b.pattern).density);
    } else {
        EXPECT_EQ(folder / std::get<ImageTexture>(a.pattern).file, std::get<ImageTexture>(b.pattern).file);
        EXPECT_EQ(std::get<ImageTexture>(a.pattern).size, std::get<ImageTexture>(b.pattern).size);
    }
}

void expect_same(const Scene& a, const Scene& b, const fs::path& folder) {
    EXPECT_EQ(a.viewer.width, b.viewer.width);
    EXPECT_EQ(a.viewer.height, b.viewer.height);
    EXPECT_EQ(a.viewer.viewport, b.viewer.viewport);
    EXPECT_EQ(a.viewer.center, b.viewer.center);
    EXPECT_EQ(a.viewer.target, b.viewer.target);
    EXPECT_EQ(a.viewer.up, b.viewer.up);
    EXPECT_EQ(a.viewer.fovy_degrees, b.viewer.fovy_degrees);
    EXPECT_EQ(a.viewer.antialiasing, b.viewer.antialiasing);
    ASSERT_EQ(a.viewer.depth_of_field.has_value(), b.viewer.depth_of_field.has_value());
    if (const auto& d = a.viewer.depth_of_field) {
        EXPECT_EQ(d->aperture_radius, b.viewer.depth_of_field->aperture_radius);
        EXPECT_EQ(d->focal_distance, b.viewer.depth_of_field->focal_distance);
        EXPECT_EQ(d->samples, b.viewer.depth_of_field->samples);
    }
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        EXPECT_EQ(a.lights[i].origin, b.lights[i].origin);
        EXPECT_EQ(a.lights[i].color, b.lights[i].color);
        EXPECT_EQ(a.lights[i].intensity, b.lights[i].intensity);
        ASSERT_EQ(a.lights[i].area.has_value(), b.lights[i].area.has_value());
        if (!a.lights[i].area) continue;
        EXPECT_EQ(a.lights[i].area->n, b.lights[i].area->n);
        EXPECT_EQ(a.lights[i].area->radius, b.lights[i].area->radius);
    }
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (std::size_t i = 0; i < a.planes.size(); ++i) {
        expect_same(a.planes[i].texture, b.planes[i].texture, folder);
        EXPECT_LT(glm::distance(glm::normalize(a.planes[i].normal), b.planes[i].normal), 1e-15);
        EXPECT_EQ(a.planes[i].offset, b.planes[i].offset);
    }
    ASSERT_EQ(a.spheres.size(), b.spheres.size());
    for (std::size_t i = 0; i < a.spheres.size(); ++i) {
        expect_same(a.spheres[i].texture, b.spheres[i].texture, folder);
        EXPECT_EQ(a.spheres[i].center, b.spheres[i].center);
        EXPECT_EQ(a.spheres[i].radius, b.spheres[i].radius);
        EXPECT_EQ(a.spheres[i].refraction_index, b.spheres[i].refraction_index);
    }
    ASSERT_EQ(a.faces.size(), b.faces.size());
    for (std::size_t i = 0; i < a.faces.size(); ++i) {
        expect_same(a.faces[i].texture, b.faces[i].texture, folder);
        EXPECT_EQ(a.faces[i].a, b.faces[i].a);
        EXPECT_EQ(a.faces[i].b, b.faces[i].b);
        EXPECT_EQ(a.faces[i].c, b.faces[i].c);
    }
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        expect_same(a.meshes[i].texture, b.meshes[i].texture, folder);
        EXPECT_EQ(folder / a.meshes[i].file, b.meshes[i].file);
        EXPECT_EQ(a.meshes[i].center, b.meshes[i].center);
        EXPECT_EQ(a.meshes[i].radius, b.meshes[i].radius);
        EXPECT_EQ(a.meshes[i].smooth, b.meshes[i].smooth);
    }
}

TEST(SceneTest, APrintedSceneIsParsedBack) {
    const TestFolder folder;
    folder.write("objs/a file.bin", "");
    Limits limits;
    limits.pixels = std::uint64_t{largest_picture} * largest_picture;
    for (unsigned seed = 0; seed < 500; ++seed) {
        RandomScene random(seed);
        const Scene scene = random.scene();
        const std::string text = random.print(scene);
        try {
            expect_same(scene, parse(text, folder.path() / "x.scene", limits), folder.path());
        } catch (const InputError& error) {
            FAIL() << seed << ": " << error.what() << "\n" << text;
        }
        ASSERT_FALSE(HasFailure()) << seed << "\n" << text;
    }
}

// Whatever happens to a good text, the parser answers: a scene, or an error with a place in the text.
TEST(SceneTest, MutatedScenesAreReadOrRefusedWithAPlace) {
    const TestFolder folder;
    folder.write("objs/a file.bin", "");
    for (unsigned seed = 0; seed < 2000; ++seed) {
        RandomScene random(seed);
        std::string text = random.print(random.scene());
        for (int i = 1 + random.below(5); i > 0; --i) {
            const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
            switch (random.below(4)) {
                case 0:
                    text[at] = static_cast<char>(random.below(256));
                    break;
                case 1:
                    text.erase(at, static_cast<std::size_t>(random.below(20)));
                    break;
                case 2:
                    text.insert(at, text.substr(text.size() / 2, static_cast<std::size_t>(random.below(30))));
                    break;
                default:
                    text.insert(at, 1, " \n\t\"#-."[random.below(7)]);
            }
            if (text.empty()) text = " ";
        }
        const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
        try {
            parse(text, folder.path() / "x.scene");
        } catch (const InputError& error) {
            ASSERT_FALSE(error.diagnostics().empty());
            for (const Diagnostic& d : error.diagnostics()) {
                EXPECT_LE(d.where.line, lines);
                EXPECT_FALSE(d.what.empty());
                EXPECT_LT(to_string(d).size(), 1000u);
            }
        }
    }
}

TEST(SceneTest, DefaultsAreThoseOfTheFormat) {
    const Scene scene = parse(std::string(viewer) + std::string(light) + std::string(sphere));
    EXPECT_EQ(scene.spheres[0].refraction_index, 1.0);
    EXPECT_FALSE(scene.viewer.viewport || scene.viewer.depth_of_field || scene.viewer.antialiasing);
    EXPECT_FALSE(scene.lights[0].area);
}

TEST(SceneTest, EveryMistakeIsReportedInTheOrderOfTheFile) {
    std::string text(viewer);
    for (int i = 0; i < 12; ++i) text += "Sphere\ntexture PureTexture PLASTIC RED\ncenter 0 0 x\n";  // no radius either
    Limits limits;
    limits.errors = 100;
    try {
        parse(text, "x.scene", limits);
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 24u);
        for (std::size_t i = 0; i < 24; ++i)
            EXPECT_EQ(error.diagnostics()[i].where.line, 7 + 3 * (i / 2) + 2 * (i % 2));
    }
}

TEST(SceneTest, ASceneWithoutLightOrShapesIsWarnedOf) {
    std::vector<Diagnostic> warnings;
    parse_scene(viewer, "x.scene", {}, warnings);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_TRUE(contains(to_string(warnings[0]), "x.scene:1:1: warning: the scene has no Light"));
}

// --- budgets ---

TEST(SceneTest, BudgetsCountProductsAndSums) {
    const std::string rest = std::string(light) + std::string(sphere);
    EXPECT_EQ(said_of(std::string(viewer) + "dop 0 1 256\nanti 256\n" + rest), "read");
    EXPECT_TRUE(contains(said_of(std::string(viewer) + "dop 0 1 257\nanti 256\n" + rest), "--max-samples"));
    EXPECT_TRUE(contains(said_of(std::string(viewer) + "dop 0 1 1000000000\nanti 1000000000\n" + rest), "too many"));
    Limits limits;
    const auto sized = [&](const char* geo) {
        std::string text(viewer);
        return text.replace(text.find("geo 64 48"), 9, geo) + rest;
    };
    EXPECT_EQ(said_of(sized("geo 4096 4096")), "read");
    EXPECT_TRUE(contains(said_of(sized("geo 4097 4096")), "--max-pixels"));
    limits.pixels = 16384ull * 16384;
    EXPECT_EQ(said_of(sized("geo 16384 16384"), "x.scene", limits), "read");
    limits.light_points = 30;
    const auto lights = [](const char* area) {
        return std::string(viewer) + std::string(sphere) + std::string(light) + "area 5 1\n" + std::string(light) +
               area;
    };
    EXPECT_EQ(said_of(lights("area 2 1\n"), "x.scene", limits), "read");
    EXPECT_TRUE(contains(said_of(lights("area 3 1\n"), "x.scene", limits), "--max-light-points"));
    EXPECT_EQ(said_of(lights(""), "x.scene", limits), "read");
}

// Megabytes that this process has held at most so far.
long most_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
}

TEST(SceneTest, ATextWithoutLineEndsCostsLittleMoreThanItself) {
    const long before = most_megabytes();
    std::string text(32u << 20, '1');
    for (std::size_t i = 0; i < text.size(); i += 2) text[i] = ' ';
    EXPECT_NE(said_of(text), "read");
    EXPECT_NE(said_of(std::string(viewer) + "anti " + text), "read");
    EXPECT_NE(said_of(std::string(viewer) + "anti " + std::string(32u << 20, '9')), "read");
    EXPECT_NE(said_of(std::string(32u << 20, 'S')), "read");
    EXPECT_LT(most_megabytes() - before, 256);
}

}  // namespace
}  // namespace raywalk
