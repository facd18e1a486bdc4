#include "tracer/files/scene_text/values.h"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "tracer/ground/spelling.h"

namespace raywalk {

namespace {

template <class Value>
using Known = std::pair<std::string_view, Value>;

constexpr Known<glm::dvec3> colors[] = {
    {"WHITE", {1, 1, 1}}, {"BLACK", {0, 0, 0}},  {"RED", {1, 0, 0}},  {"GREEN", {0, 1, 0}},
    {"BLUE", {0, 0, 1}},  {"YELLOW", {1, 1, 0}}, {"CYAN", {0, 1, 1}}, {"MAGENTA", {1, 0, 1}},
};
constexpr Known<double> refraction_indices[] = {
    {"VACUUM_REFRACTION_INDEX", 1.0},
    {"WATER_REFRACTION_INDEX", 1.333},
    {"GLASS_REFRACTION_INDEX", 1.5},
};
constexpr Known<bool> booleans[] = {{"true", true}, {"false", false}, {"True", true}, {"False", false}};

enum class PatternName { pure, grid, image };
constexpr Known<PatternName> patterns[] = {
    {"PureTexture", PatternName::pure}, {"GridTexture", PatternName::grid}, {"ImageTexture", PatternName::image}};

constexpr int largest_texture = 1'000'000;  // grid density and image size; more would be noise

// A sign '+' before a number is fine; the number readers know only '-'.
std::string_view without_plus(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
    return text;
}

// `value` in the shortest form that reads back: "1e-12", "1e12", "16384".
std::string shortest(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), std::remove(buffer.data(), end, '+')};
}

std::string spoken(Range range) {
    if (range.open) return "expected a number above " + shortest(range.least) + " and below " + shortest(range.most);
    return "expected a number from " + shortest(range.least) + " to " + shortest(range.most);
}

bool contains(Range range, double value) {
    return range.open ? value > range.least && value < range.most : value >= range.least && value <= range.most;
}

}  // namespace

const Word* SceneValues::take(std::string_view name) {
    if (failed_) return nullptr;
    if (more()) return &line_.words[next_++];
    const std::string property = quoted(line_.words.front().text);
    fail(line_.words.front(), next_ == 1 ? property + " has no value" : property + " lacks " + std::string(name), "");
    return nullptr;
}

void SceneValues::fail(const Word& word, std::string what, std::string expected) {
    if (expected.empty()) expected = "expected: " + std::string(form_);
    report_.error(place_of(line_, word), std::move(what), std::move(expected));
    failed_ = true;
}

int SceneValues::integer(std::string_view name, int least, int most) {
    const Word* word = take(name);
    if (!word) return least;
    const std::string_view text = without_plus(word->text);
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto range = [&] {
        return "expected a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    };
    if (end != text.data() + text.size() || error == std::errc::invalid_argument || word->quoted)
        fail(*word, quoted(word->text) + " is not a whole number", range());
    else if (error != std::errc{} || value < least || value > most)
        fail(*word, quoted(word->text) + " is out of range for " + std::string(name), range());
    return failed_ ? least : static_cast<int>(value);
}

double SceneValues::number(std::string_view name, Range range) {
    const Word* word = take(name);
    if (!word) return range.most;
    const std::string_view text = without_plus(word->text);
    double value = 0;
    const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || word->quoted) {
        const bool comma = text.find(',') != std::string_view::npos;
        fail(*word, quoted(word->text) + " is not a number",
             comma ? "write numbers with a point and blanks between them: 0.5 1 2" : spoken(range));
    } else if (std::isnan(value) || text.find_first_of("iI") != std::string_view::npos) {
        fail(*word, quoted(word->text) + " is not a finite number", spoken(range));
    } else if (!contains(range, value)) {
        fail(*word, quoted(word->text) + " is out of range for " + std::string(name), spoken(range));
    }
    return failed_ ? range.most : value;
}

glm::dvec3 SceneValues::vector(Range range) {
    const double x = number("x", range), y = number("y", range), z = number("z", range);
    return {x, y, z};
}

template <class Value>
Value SceneValues::one_of(std::string_view name, std::string_view kind, std::span<const Known<Value>> known,
                          const Value& otherwise) {
    const Word* word = take(name);
    if (!word) return otherwise;
    for (const auto& [text, value] : known)
        if (word->text == text && !word->quoted) return value;
    std::vector<std::string_view> names;
    for (const auto& entry : known) names.push_back(entry.first);
    fail(*word, quoted(word->text) + " is not " + std::string(kind), suggestion(word->text, names));
    return otherwise;
}

glm::dvec3 SceneValues::color() { return one_of<glm::dvec3>("a color", "a color", colors, glm::dvec3{1}); }

bool SceneValues::boolean(std::string_view name) { return one_of<bool>(name, "true or false", booleans, false); }

double SceneValues::refraction_index() {
    return one_of<double>("a refraction index", "a refraction index", refraction_indices, 1.0);
}

Material SceneValues::material() {
    static constexpr auto known = [] {
        std::array<Known<const Material*>, std::size(materials)> table{};
        for (std::size_t i = 0; i < std::size(materials); ++i) table[i] = {materials[i].name, &materials[i]};
        return table;
    }();
    return *one_of<const Material*>("a material", "a material", known, &materials[0]);
}

Texture SceneValues::texture() {
    Texture texture;
    const auto pattern = one_of<PatternName>("a texture", "a texture", patterns, PatternName::pure);
    if (failed_) return texture;
    form_ = pattern == PatternName::pure   ? "texture PureTexture MATERIAL COLOR"
            : pattern == PatternName::grid ? "texture GridTexture MATERIAL DENSITY"
                                           : "texture ImageTexture MATERIAL FILE [SIZE]";
    texture.material = material();
    switch (pattern) {
        case PatternName::pure:
            texture.pattern = PureTexture{color()};
            break;
        case PatternName::grid:
            texture.pattern = GridTexture{integer("the density", 1, largest_texture)};
            break;
        case PatternName::image: {
            ImageTexture image;
            image.file = file(image.where);
            if (!failed_ && more()) image.size = integer("the size", 1, largest_texture);
            texture.pattern = std::move(image);
        }
    }
    return texture;
}

Texture SceneValues::pure_texture(std::string_view block) {
    form_ = "texture PureTexture MATERIAL COLOR";
    if (more() && (line_.words[next_].text == "GridTexture" || line_.words[next_].text == "ImageTexture")) {
        fail(line_.words[next_], "a " + std::string(block) + " takes a PureTexture only", "");
        return {};
    }
    return texture();
}

std::filesystem::path SceneValues::file(SourceLocation& where) {
    const Word* word = take("a file");
    if (!word) return {};
    where = report_.location(place_of(line_, *word));
    if (line_.open_quote && word == &line_.words.back()) {
        fail(*word, "the quote is not closed", "expected \" at the end of the name");
        return {};
    }
    const NamedFiles::Found& found = files_.find(word->text);
    const bool blanks =
        !word->quoted && more() && !std::isdigit(static_cast<unsigned char>(line_.words[next_].text[0]));
    if (!found.problem.empty())
        fail(*word, quoted(word->text) + " " + found.problem,
             blanks ? "put a name with blanks in double quotes" : found.advice);
    return found.path;
}

bool SceneValues::finish() {
    if (!failed_ && more()) {
        const Word& word = line_.words[next_];
        const bool comment = word.text.starts_with('#');
        fail(word, "unexpected " + quoted(word.text) + " after the last value",
             comment ? "a comment needs a line of its own" : "");
    }
    return !failed_;
}

}  // namespace raywalk
