#include "tracer/files/scene_text/parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <utility>

#include "tracer/files/scene_text/lexer.h"
#include "tracer/files/scene_text/values.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/ground/spelling.h"

namespace raywalk {

namespace {

// One property of a block: its name, how it looks, and what reads its values.
template <class Block>
struct Property {
    std::string_view name, form;
    bool required;
    void (*read)(SceneValues&, Block&);
};

constexpr int largest_viewport = 1'000'000'000;  // scene units
constexpr int largest_count = 1'000'000'000;     // of samples; their product has its own budget

constexpr Property<Viewer> viewer_properties[] = {
    {"geo", "geo WIDTH HEIGHT", true,
     [](SceneValues& v, Viewer& b) {
         b.width = v.integer("the width", 1, largest_picture);
         b.height = v.integer("the height", 1, largest_picture);
     }},
    {"view", "view WIDTH HEIGHT", false,
     [](SceneValues& v, Viewer& b) {
         const int width = v.integer("the width", 1, largest_viewport),
                   height = v.integer("the height", 1, largest_viewport);
         b.viewport = glm::dvec2(width, height);
     }},
    {"center", "center X Y Z", true, [](SceneValues& v, Viewer& b) { b.center = v.vector(); }},
    {"target", "target X Y Z", true, [](SceneValues& v, Viewer& b) { b.target = v.vector(); }},
    {"up", "up X Y Z", true, [](SceneValues& v, Viewer& b) { b.up = v.vector(); }},
    {"fovy", "fovy DEGREES", true,
     [](SceneValues& v, Viewer& b) {
         b.fovy_degrees = v.number("the field of view", {0, 180, true});
     }},
    {"dop", "dop APERTURE_RADIUS FOCAL_DISTANCE SAMPLES", false,
     [](SceneValues& v, Viewer& b) {
         DepthOfField dop;
         dop.aperture_radius = v.number("the aperture radius", length_or_zero);
         dop.focal_distance = v.number("the focal distance", positive_length);
         dop.samples = v.integer("the sample count", 1, largest_count);
         b.depth_of_field = dop;
     }},
    {"anti", "anti SAMPLES", false,
     [](SceneValues& v, Viewer& b) { b.antialiasing = v.integer("the sample count", 1, largest_count); }},
};

constexpr Property<Light> light_properties[] = {
    {"area", "area N RADIUS", false,
     [](SceneValues& v, Light& b) {
         AreaSpread area;
         area.n = v.integer("n", 1, 30'000);  // n * n fits an int
         area.radius = v.number("the radius", length_or_zero);
         b.area = area;
     }},
    {"origin", "origin X Y Z", true, [](SceneValues& v, Light& b) { b.origin = v.vector(); }},
    {"color", "color COLOR", true, [](SceneValues& v, Light& b) { b.color = v.color(); }},
    {"intensity", "intensity NUMBER", true,
     [](SceneValues& v, Light& b) { b.intensity = v.number("the intensity", length_or_zero); }},
};

constexpr Property<Plane> plane_properties[] = {
    {"texture", "texture PureTexture MATERIAL COLOR (or GridTexture, ImageTexture)", true,
     [](SceneValues& v, Plane& b) { b.texture = v.texture(); }},
    {"normal", "normal X Y Z", true, [](SceneValues& v, Plane& b) { b.normal = v.vector(); }},
    {"offset", "offset NUMBER", true, [](SceneValues& v, Plane& b) { b.offset = v.number("the offset", coordinate); }},
};

constexpr Property<Sphere> sphere_properties[] = {
    {"texture", "texture PureTexture MATERIAL COLOR (or GridTexture, ImageTexture)", true,
     [](SceneValues& v, Sphere& b) { b.texture = v.texture(); }},
    {"center", "center X Y Z", true, [](SceneValues& v, Sphere& b) { b.center = v.vector(); }},
    {"radius", "radius NUMBER", true,
     [](SceneValues& v, Sphere& b) { b.radius = v.number("the radius", positive_length); }},
    {"refraction_index", "refraction_index INDEX", false,
     [](SceneValues& v, Sphere& b) { b.refraction_index = v.refraction_index(); }},
};

constexpr Property<Face> face_properties[] = {
    {"texture", "texture PureTexture MATERIAL COLOR", true,
     [](SceneValues& v, Face& b) { b.texture = v.pure_texture("Face"); }},
    {"a", "a X Y Z", true, [](SceneValues& v, Face& b) { b.a = v.vector(); }},
    {"b", "b X Y Z", true, [](SceneValues& v, Face& b) { b.b = v.vector(); }},
    {"c", "c X Y Z", true, [](SceneValues& v, Face& b) { b.c = v.vector(); }},
};

constexpr Property<Mesh> mesh_properties[] = {
    {"texture", "texture PureTexture MATERIAL COLOR", true,
     [](SceneValues& v, Mesh& b) { b.texture = v.pure_texture("Mesh"); }},
    {"file", "file NAME", true, [](SceneValues& v, Mesh& b) { b.file = v.file(b.where); }},
    {"center", "center X Y Z", true, [](SceneValues& v, Mesh& b) { b.center = v.vector(); }},
    {"radius", "radius NUMBER", true,
     [](SceneValues& v, Mesh& b) { b.radius = v.number("the radius", positive_length); }},
    {"smooth", "smooth true|false", false, [](SceneValues& v, Mesh& b) { b.smooth = v.boolean("the choice"); }},
};

constexpr std::string_view block_names[] = {"Viewer", "Light", "Plane", "Sphere", "Face", "Mesh"};

bool is_block_name(std::string_view word) { return std::ranges::find(block_names, word) != std::end(block_names); }

// A line of one word that is near a block's name, or begins with a capital as only blocks do.
bool looks_like_block(const SceneLine& line) {
    const std::string_view word = line.words.front().text;
    return line.words.size() == 1 && !word.empty() &&
           ((word[0] >= 'A' && word[0] <= 'Z') || nearest_word(word, block_names));
}

// The blocks that have a property of this name: "Sphere, Mesh"; empty for none.
std::string owners_of(std::string_view name) {
    std::vector<std::string_view> owners;
    const auto look = [&](std::string_view block, const auto& properties) {
        for (const auto& p : properties)
            if (p.name == name) owners.push_back(block);
    };
    look("Viewer", viewer_properties);
    look("Light", light_properties);
    look("Plane", plane_properties);
    look("Sphere", sphere_properties);
    look("Face", face_properties);
    look("Mesh", mesh_properties);
    return listed(owners);
}

// v / |v|, whatever its size, or nothing where v is 0.
std::optional<glm::dvec3> direction(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest < smallest_length) return std::nullopt;
    return glm::normalize(v / largest);
}

// One pass over a scene text.
class Parser {
  public:
    Parser(std::string_view text, const std::filesystem::path& file, const Limits& limits)
        : lexer_(text), limits_(limits), files_(file, limits), report_(file.string(), limits.errors) {
        scene_.file = file;
    }

    Scene parse(std::vector<Diagnostic>& warnings);

  private:
    // Where each property of the block just read stands, by its index; no line number: it is not there.
    template <std::size_t N>
    using Seen = std::array<Place, N>;

    // Reads the properties of a block up to the next block. True if it is complete and has no mistake.
    template <class Block, std::size_t N>
    bool read_block(const Property<Block> (&properties)[N], Block& block, Seen<N>& seen);
    template <class Block, std::size_t N>
    bool read_property(const Property<Block> (&properties)[N], Block& block, Seen<N>& seen);
    template <class Block, std::size_t N>
    void report_unknown(const Property<Block> (&properties)[N], std::string_view block, Seen<N>& seen);
    template <class Block, std::size_t N>
    bool report_missing(const Property<Block> (&properties)[N], const Seen<N>& seen, const Place& name,
                        std::string_view block);

    void read_any_block();
    void read_viewer();
    void read_light();
    void read_plane();
    void report_stray_line();
    void check_whole_scene();

    bool advance() { return more_ = !report_.full() && lexer_.next(line_); }
    [[nodiscard]] const Word& first() const { return line_.words.front(); }

    SceneLexer lexer_;
    SceneLine line_;  // the line being read
    bool more_ = false;
    const Limits& limits_;
    NamedFiles files_;
    SceneReport report_;
    Scene scene_;
    std::optional<Place> viewer_;  // the Viewer block's name
    bool viewer_misspelt_ = false;
    std::uint64_t light_points_ = 0;  // so far
};

template <class Block, std::size_t N>
bool Parser::read_property(const Property<Block> (&properties)[N], Block& block, Seen<N>& seen) {
    for (std::size_t i = 0; i < N; ++i) {
        if (properties[i].name != first().text) continue;
        const Place place = place_of(line_, first());
        if (seen[i].number > 0) {
            report_.error(place, quoted(first().text) + " is given twice",
                          "the first one is on line " + std::to_string(seen[i].number));
            return true;
        }
        seen[i] = place;
        SceneValues values(line_, properties[i].form, report_, files_);
        properties[i].read(values, block);
        values.finish();
        return true;
    }
    return false;
}

template <class Block, std::size_t N>
void Parser::report_unknown(const Property<Block> (&properties)[N], std::string_view block, Seen<N>& seen) {
    std::vector<std::string_view> names;
    for (const auto& p : properties) names.push_back(p.name);
    const Place place = place_of(line_, first());
    if (const std::string owners = owners_of(first().text); !owners.empty())
        return report_.error(place, "a " + std::string(block) + " has no " + quoted(first().text),
                             "it belongs to " + owners + "; a " + std::string(block) + " has " + listed(names));
    report_.error(place, "unknown property " + quoted(first().text), suggestion(first().text, names));
    // What is misspelt here is not missing as well.
    const auto meant = nearest_word(first().text, names);
    for (std::size_t i = 0; meant && i < N; ++i)
        if (names[i] == *meant && seen[i].number == 0) seen[i] = place;
}

template <class Block, std::size_t N>
bool Parser::report_missing(const Property<Block> (&properties)[N], const Seen<N>& seen, const Place& name,
                            std::string_view block) {
    std::vector<std::string_view> missing, forms;
    for (std::size_t i = 0; i < N; ++i) {
        if (!properties[i].required || seen[i].number > 0) continue;
        missing.push_back(properties[i].name);
        forms.push_back(properties[i].form);
    }
    if (missing.empty()) return false;
    report_.error(name, "this " + std::string(block) + " lacks " + listed(missing), "add: " + listed(forms));
    return true;
}

template <class Block, std::size_t N>
bool Parser::read_block(const Property<Block> (&properties)[N], Block& block, Seen<N>& seen) {
    const std::size_t errors_before = report_.count();
    const Place name = place_of(line_, first());
    const std::string_view kind = first().text;
    if (line_.words.size() > 1)
        report_.error(place_of(line_, line_.words[1]), "unexpected " + quoted(line_.words[1].text),
                      "a block's name stands alone on its line; its properties follow, one a line");
    while (advance() && !is_block_name(first().text)) {
        if (read_property(properties, block, seen)) continue;
        if (looks_like_block(line_)) break;
        report_unknown(properties, kind, seen);
    }
    return !report_missing(properties, seen, name, kind) && report_.count() == errors_before;
}

void Parser::read_viewer() {
    const Place name = place_of(line_, first());
    if (viewer_)
        report_.error(name, "a scene has one Viewer only",
                      "the first one is on line " + std::to_string(viewer_->number));
    else
        viewer_ = name;
    Viewer viewer;
    Seen<std::size(viewer_properties)> seen{};
    if (!read_block(viewer_properties, viewer, seen)) return;
    const auto place = [&](std::string_view property) {
        const auto same = [&](const auto& p) { return p.name == property; };
        return seen[std::ranges::find_if(viewer_properties, same) - std::begin(viewer_properties)];
    };
    if (const std::uint64_t pixels =
            static_cast<std::uint64_t>(viewer.width) * static_cast<std::uint64_t>(viewer.height);
        pixels > limits_.pixels)
        report_.error(place("geo"), "the picture has " + std::to_string(pixels) + " pixels: too many",
                      how_to_raise(limits_, &Limits::pixels));
    const auto view = direction(viewer.target - viewer.center);
    const auto up = direction(viewer.up);
    // Below a millionth of a radian the rounding of the inputs decides which way is up.
    if (!view)
        report_.error(place("target"), "target and center are the same point", "the view needs a direction");
    else if (!up)
        report_.error(place("up"), "the vector has no length", "expected a direction, such as 0 1 0");
    else if (glm::length(glm::cross(*view, *up)) < 1e-6)
        report_.error(place("up"), "up is parallel to the view direction", "expected a direction across it");
    const std::uint64_t dop = viewer.depth_of_field ? viewer.depth_of_field->samples : 1;
    const std::uint64_t anti = viewer.antialiasing.value_or(1);
    if (dop * anti > limits_.samples)
        report_.error(place(dop >= anti ? "dop" : "anti"),
                      std::to_string(dop * anti) + " samples per pixel are too many",
                      how_to_raise(limits_, &Limits::samples));
    scene_.viewer = viewer;
}

void Parser::read_light() {
    Light light;
    Seen<std::size(light_properties)> seen{};
    const Place name = place_of(line_, first());
    if (!read_block(light_properties, light, seen)) return;
    const std::uint64_t n = light.area ? light.area->n : 1;
    const bool fitted = light_points_ <= limits_.light_points;
    light_points_ += n * n;
    if (fitted && light_points_ > limits_.light_points)
        report_.error(light.area ? seen[0] : name,
                      "up to here the lights have " + std::to_string(light_points_) + " points: too many",
                      how_to_raise(limits_, &Limits::light_points));
    scene_.lights.push_back(light);
}

void Parser::read_plane() {
    Plane plane;
    Seen<std::size(plane_properties)> seen{};
    if (!read_block(plane_properties, plane, seen)) return;
    if (const auto unit = direction(plane.normal))
        plane.normal = *unit;
    else
        report_.error(seen[1], "the normal has no length", "expected a direction, such as 0 1 0");
    scene_.planes.push_back(std::move(plane));
}

// A line where a block should start does not start one: says so, and goes on to the next block.
void Parser::report_stray_line() {
    const Place place = place_of(line_, first());
    const std::string owners = owners_of(first().text);
    viewer_misspelt_ |= nearest_word(first().text, block_names) == block_names[0];
    if (owners.empty())
        report_.error(place, "unknown block " + quoted(first().text), suggestion(first().text, block_names));
    else
        report_.error(place, quoted(first().text) + " stands before any block",
                      "it is a property of " + owners + ": write the block's name on a line above it");
    while (advance() && !is_block_name(first().text)) {
    }
}

void Parser::read_any_block() {
    const auto read = [&]<class Block, std::size_t N>(const Property<Block>(&properties)[N], std::vector<Block>& into) {
        Seen<N> seen{};
        if (Block block; read_block(properties, block, seen)) into.push_back(std::move(block));
    };
    const std::string_view kind = first().text;
    if (kind == "Viewer")
        read_viewer();
    else if (kind == "Light")
        read_light();
    else if (kind == "Plane")
        read_plane();
    else if (kind == "Sphere")
        read(sphere_properties, scene_.spheres);
    else if (kind == "Face")
        read(face_properties, scene_.faces);
    else if (kind == "Mesh")
        read(mesh_properties, scene_.meshes);
    else
        report_stray_line();
}

void Parser::check_whole_scene() {
    if (report_.full()) return;
    if (!viewer_ && !viewer_misspelt_)
        report_.error_of_file("no Viewer in this scene",
                              "a scene needs a Viewer with geo, center, target, up and fovy");
    if (report_.count() > 0) return;
    if (scene_.lights.empty()) report_.warning(*viewer_, "the scene has no Light", "everything will be black");
    if (scene_.planes.empty() && scene_.spheres.empty() && scene_.faces.empty() && scene_.meshes.empty())
        report_.warning(*viewer_, "the scene has nothing to see", "add a Plane, Sphere, Face or Mesh");
}

Scene Parser::parse(std::vector<Diagnostic>& warnings) {
    advance();
    while (more_) read_any_block();
    check_whole_scene();
    report_.finish(warnings);
    return std::move(scene_);
}

// Refuses text that is no text: a message about its first wrong byte.
void require_text(std::string_view text, const std::filesystem::path& file) {
    const std::size_t at = first_foreign_byte(text);
    if (at == std::string_view::npos) return;
    const std::size_t begin = text.substr(0, at).rfind('\n') + 1;  // npos + 1 == 0
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const auto number = static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n')) + 1;
    const auto byte = static_cast<unsigned char>(text[at]);
    const char* digits = "0123456789ABCDEF";
    const std::string hex = {digits[byte >> 4], digits[byte & 15]};
    Diagnostic diagnostic = error_at({file.string(), number, at - begin + 1},
                                     "the byte 0x" + hex + (byte < 0x80 ? " has no place in a scene" : " is not UTF-8"),
                                     "a scene is text in UTF-8");
    quote_line(diagnostic, text.substr(begin, end - begin));
    throw InputError(std::move(diagnostic));
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file, const Limits& limits,
                  std::vector<Diagnostic>& warnings) {
    require_text(text, file);
    return Parser(text, file, limits).parse(warnings);
}

Scene read_scene(const std::filesystem::path& file, const Limits& limits, std::vector<Diagnostic>& warnings) {
    try {
        const FileBytes bytes = read_text_bytes(open_file(file), limits.scene_bytes);
        return parse_scene(bytes.text(), file, limits, warnings);
    } catch (const FileProblem& problem) {
        const std::string advice = problem.too_large ? how_to_raise(limits, &Limits::scene_bytes)
                                                     : "expected a scene file, such as scenes/cornell_box.scene";
        throw InputError(error_of_file(file.string(), problem.what(), advice));
    }
}

}  // namespace raywalk
