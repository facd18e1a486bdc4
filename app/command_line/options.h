// What the command line says, checked as far as it can be without opening a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "app/walk/walk_script.h"
#include "tracer/compiled/compile.h"
#include "tracer/picture/camera.h"
#include "tracer/scene/limits.h"

namespace raywalk {

enum class Mode { travel, render, capture, check };
enum class Verbosity { quiet, normal, verbose };

// How radiance becomes display values (spec 4.8): a factor, or the factor that brings the largest channel to 1.
struct Exposure {
    std::optional<float> value;  // none: normalize
    friend bool operator==(const Exposure&, const Exposure&) = default;
};

struct Options {
    Mode mode = Mode::travel;
    std::filesystem::path scene;
    std::filesystem::path output;                // of render and capture
    std::optional<std::string> frames;           // of capture: file name with one %d or %04d, counted from 0
    std::optional<std::filesystem::path> stats;  // "-" is stdout
    std::optional<glm::ivec2> size;              // pixels, each 1..16384
    std::optional<std::uint32_t> samples_per_pixel;
    std::optional<Projection> projection;
    std::optional<Exposure> exposure;
    std::uint32_t seed = 0;
    int threads = 1;  // resolved: never 0
    WalkScript keys;
    std::optional<std::string> isa;
    CompileOptions compile;
    Limits limits;
    Verbosity verbosity = Verbosity::normal;
};

// A wrong command line (exit code 2). The message is complete, several lines perhaps.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Nothing to run: --help or --version. `text` goes to stdout, exit code 0.
struct Answer {
    std::string text;
};

// Throws UsageError. `arguments` are argv[1..].
std::variant<Options, Answer> parse_command_line(const std::vector<std::string>& arguments);

}  // namespace raywalk
