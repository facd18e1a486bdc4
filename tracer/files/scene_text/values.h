// The values of one property of a scene, read from left to right; and the report that mistakes go to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tracer/files/scene_folders.h"
#include "tracer/files/scene_text/lexer.h"
#include "tracer/ground/error.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

namespace raywalk {

// A word in the text, to point at later. The line must outlive it.
struct Place {
    std::string_view line;
    std::size_t number = 0, column = 1, length = 1;  // line and column from 1
    friend bool operator==(const Place&, const Place&) = default;
};
Place place_of(const SceneLine& line, const Word& word);

// The mistakes of one scene file, up to the limit.
class SceneReport {
  public:
    SceneReport(std::string file, std::uint64_t most_errors) : file_(std::move(file)), most_errors_(most_errors) {}

    void error(const Place& place, std::string what, std::string expected);
    void error_of_file(std::string what, std::string expected);
    void warning(const Place& place, std::string what, std::string expected);
    [[nodiscard]] SourceLocation location(const Place& place) const;
    [[nodiscard]] bool full() const { return errors_.size() >= most_errors_; }
    [[nodiscard]] std::size_t count() const { return errors_.size(); }
    // Throws InputError, in the order of the file, if there was an error; else hands the warnings over.
    void finish(std::vector<Diagnostic>& warnings);

  private:
    void add(std::vector<Diagnostic>& list, Diagnostic diagnostic, std::string_view line);

    std::string file_;
    std::uint64_t most_errors_;
    std::vector<Diagnostic> errors_, warnings_;
};

// Files that a scene names: found from the scene's folder, kept inside the parent of that folder (links followed) or
// an allowed folder, and looked at once each. A file named in several ways (through "./", by links) is one file.
class NamedFiles {
  public:
    NamedFiles(const std::filesystem::path& scene, const Limits& limits);

    struct Found {
        std::filesystem::path path;
        std::string problem, advice;  // empty when the file may be read
    };
    const Found& find(std::string_view name);

  private:
    using Identity = std::pair<std::uint64_t, std::uint64_t>;  // device and inode

    Found look(std::string_view name);

    std::filesystem::path scene_, folder_;
    SceneFolders folders_;
    std::map<Identity, std::filesystem::path> first_names_;
    std::map<std::string, Found, std::less<>> seen_;
};

// Numbers from least to most; open: without the ends.
struct Range {
    double least, most;
    bool open = false;
};
inline constexpr Range coordinate{-largest_length, largest_length};
inline constexpr Range positive_length{smallest_length, largest_length};
inline constexpr Range length_or_zero{0, largest_length};

// Reads the words after a property's name. The first mistake is reported; from then on every read gives a default.
class SceneValues {
  public:
    // `form` is the property as it should look: "center X Y Z".
    SceneValues(const SceneLine& line, std::string_view form, SceneReport& report, NamedFiles& files)
        : line_(line), form_(form), report_(report), files_(files) {}

    int integer(std::string_view name, int least, int most);
    double number(std::string_view name, Range range);
    glm::dvec3 vector(Range range = coordinate);
    glm::dvec3 color();
    bool boolean(std::string_view name);
    double refraction_index();
    Material material();
    Texture texture();
    Texture pure_texture(std::string_view block);
    // A file of this scene; where is the place of its name.
    std::filesystem::path file(SourceLocation& where);

    // Reports what follows the last value. True if the property was read without a mistake.
    bool finish();

  private:
    const Word* take(std::string_view name);
    template <class Value>
    Value one_of(std::string_view name, std::string_view kind,
                 std::span<const std::pair<std::string_view, Value>> known, const Value& otherwise);
    void fail(const Word& word, std::string what, std::string expected);
    [[nodiscard]] bool more() const { return next_ < line_.words.size(); }

    const SceneLine& line_;
    std::string_view form_;
    SceneReport& report_;
    NamedFiles& files_;
    std::size_t next_ = 1;
    bool failed_ = false;
};

}  // namespace raywalk
