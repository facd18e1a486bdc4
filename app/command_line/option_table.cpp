#include "app/command_line/option_table.h"

#include <charconv>
#include <cmath>

#include "app/process/cores.h"
#include "tracer/ground/spelling.h"
#include "tracer/kernels/kernels.h"

namespace raywalk {

namespace {

[[noreturn]] void wrong_value(std::string_view option, const std::string& value, const std::string& expected) {
    throw UsageError(std::string(option) + ": expected " + expected + ", not " + raywalk::quoted(value));
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return number;
}

// A whole number in [lowest, highest].
template <class Integer>
Integer integer(std::string_view option, const std::string& value, Integer lowest, Integer highest) {
    const auto number = number_of<Integer>(value);
    if (!number || *number < lowest || *number > highest)
        wrong_value(option, value, "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
    return *number;
}

float positive(std::string_view option, const std::string& value, const std::string& expected) {
    const auto number = number_of<float>(value);
    if (!number || !std::isnormal(*number) || *number < 0) wrong_value(option, value, expected);
    return *number;
}

glm::ivec2 size_in_pixels(const std::string& value) {
    const std::size_t cross = value.find_first_of("xX");
    const std::string_view text = value;
    if (cross != std::string::npos) {
        const auto width = number_of<int>(text.substr(0, cross)), height = number_of<int>(text.substr(cross + 1));
        const auto in_range = [](int pixels) { return pixels >= 1 && pixels <= largest_picture; };
        if (width && height && in_range(*width) && in_range(*height)) return {*width, *height};
    }
    wrong_value("--size", value,
                "WIDTHxHEIGHT in pixels such as 1280x720, each from 1 to " + std::to_string(largest_picture));
}

// One of `words`, as an index.
template <std::size_t n>
std::size_t choice(std::string_view option, const std::string& value, const std::string_view (&words)[n]) {
    for (std::size_t i = 0; i < n; ++i)
        if (words[i] == value) return i;
    throw UsageError(std::string(option) + ": unknown " + raywalk::quoted(value) + ": " + suggestion(value, words));
}

Exposure exposure(const std::string& value) {
    if (value == "normalize") return {};
    return {positive("--exposure", value, "'normalize' or a number above 0 such as 1.5")};
}

std::string instruction_set(const std::string& value) {
    std::vector<std::string_view> names;
    for (const Kernels* kernels : available_kernels()) names.push_back(kernels->name);
    for (const std::string_view name : names)
        if (name == value) return value;
    throw UsageError("--isa: this processor has no " + raywalk::quoted(value) + ": " + suggestion(value, names));
}

void set_kd(CommandLine& line) { line.kd_option_given = true; }

constexpr std::string_view projections[] = {"perspective", "orthographic"};
constexpr std::string_view accelerators[] = {"kdtree", "bvh"};

using Line = CommandLine;
using Value = const std::string&;
using enum OptionGroup;

const OptionSpec table[] = {
    {"--travel", "", "", mode, "walk through the scene in a window (the default); also -travel",
     [](Line& line, Value) { line.travel = true; }},
    {"--render", "", "OUT", mode,
     "render once and write OUT: .png .jpg hold display values, .exr .pfm .hdr .tif linear radiance; also -render",
     [](Line& line, Value value) { line.render = true, line.options.output = value; }},
    {"--capture", "", "OUT", mode,
     "no window: press --keys, accumulate --spp samples, write what the window would show",
     [](Line& line, Value value) { line.capture = true, line.options.output = value; }},
    {"--check", "", "", mode, "read the scene with its meshes and images, say what it holds, render nothing",
     [](Line& line, Value) { line.check = true; }},

    {"--size", "", "WxH", picture, "size of the picture in pixels (else the scene's geo)",
     [](Line& line, Value value) { line.options.size = size_in_pixels(value); }},
    {"--spp", "", "N", picture, "samples per pixel (else the scene's dop count x anti count, else 1)",
     [](Line& line, Value value) {
         // Counts above 2^24 are not exact in single precision.
         line.options.samples_per_pixel = integer<std::uint32_t>("--spp", value, 1, 1u << 24);
     }},
    {"--projection", "", "NAME", picture, "perspective or orthographic (else the scene's choice)",
     [](Line& line, Value value) {
         line.options.projection =
             choice("--projection", value, projections) == 0 ? Projection::perspective : Projection::orthographic;
     }},
    {"--exposure", "", "VALUE", picture,
     "'normalize' darkens the picture until nothing is over 1 (the default); a number multiplies and clips",
     [](Line& line, Value value) { line.options.exposure = exposure(value); }},
    {"--seed", "", "N", picture, "seed of every random choice (default 0)",
     [](Line& line, Value value) { line.options.seed = integer<std::uint32_t>("--seed", value, 0, ~0u); }},

    {"--keys", "", "SCRIPT", walking,
     "walk steps to press first: '12w 3R t' is 12 steps forward, 3 turns to the right, "
     "the other projection",
     [](Line& line, Value value) { line.options.keys = parse_walk_script(value, "--keys"); }},
    {"--frames", "", "PATTERN", walking, "with --capture: also write the frame after every key, as walk-%04d.png does",
     [](Line& line, Value value) { line.options.frames = value; }},

    {"--threads", "", "N", speed, "threads (default: every core this process may use)",
     [](Line& line, Value value) { line.options.threads = integer<int>("--threads", value, 1, most_threads); }},
    {"--accelerator", "", "NAME", speed, "bvh (default) or kdtree: same picture, another way to find what a ray hits",
     [](Line& line, Value value) {
         line.accelerator_given = true;
         line.options.compile.accelerator =
             choice("--accelerator", value, accelerators) == 0 ? Accelerator::kdtree : Accelerator::bvh;
     }},
    {"--isa", "", "NAME", speed, "instruction set of the kernels (default: the best of this processor)",
     [](Line& line, Value value) { line.options.isa = instruction_set(value); }},
    {"--leaf-limit", "", "N", speed, "kd-tree: so many shapes or fewer always make a leaf (default 16)",
     [](Line& line, Value value) {
         set_kd(line), line.options.compile.kd.leaf_limit = integer<int>("--leaf-limit", value, 1, 1024);
     }},
    {"--depth-limit", "", "N", speed, "kd-tree: deepest level (default 8 + 1.6 log2 of the shapes)",
     [](Line& line, Value value) {
         set_kd(line), line.options.compile.kd.depth_limit = integer<int>("--depth-limit", value, 1, KdTree::max_depth);
     }},
    {"--traversal-cost", "", "KT", speed, "kd-tree: cost of visiting a node",
     [](Line& line, Value value) {
         set_kd(line), line.options.compile.kd.traversal_cost =
                           positive("--traversal-cost", value, "a number above 0 such as 0.75");
     }},
    {"--intersection-cost", "", "KI", speed, "kd-tree: cost of testing a block of 16 shapes",
     [](Line& line, Value value) {
         set_kd(line), line.options.compile.kd.intersection_cost =
                           positive("--intersection-cost", value, "a number above 0 such as 1.0");
     }},

    {"--stats", "", "FILE", output, "write scene counts, times, rays, rays per second, the tree, as JSON ('-': stdout)",
     [](Line& line, Value value) { line.options.stats = value; }},
    {"--quiet", "-q", "", output, "say nothing but errors", [](Line& line, Value) { line.quiet = true; }},
    {"--verbose", "-v", "", output, "say more: times of loading and building, threads, instruction set",
     [](Line& line, Value) { line.verbose = true; }},
    {"--help", "-h", "", output, "show this help", [](Line& line, Value) { line.help = true; }},
    {"--version", "", "", output, "show the version", [](Line& line, Value) { line.version = true; }},

    {"--allow-path", "", "DIR", limits,
     "a folder that scenes may name files in, beside the parent of their own; "
     "may be given several times",
     [](Line& line, Value value) { line.options.limits.allowed_folders.emplace_back(value); }, true},
};

// The options of `limit_options`: one function for each, as `apply` carries no state.
template <std::size_t i>
void raise_limit(CommandLine& line, const std::string& value) {
    line.options.limits.*limit_options[i].value =
        integer<std::uint64_t>(limit_options[i].name, value, 1, std::uint64_t{1} << 53);
}

template <std::size_t... i>
std::vector<OptionSpec> whole_table(std::index_sequence<i...>) {
    std::vector<OptionSpec> all(std::begin(table), std::end(table));
    (all.push_back({limit_options[i].name, "", "N", limits, limit_options[i].meaning, raise_limit<i>}), ...);
    return all;
}

}  // namespace

std::span<const OptionSpec> option_table() {
    static const std::vector<OptionSpec> all = whole_table(std::make_index_sequence<std::size(limit_options)>());
    return all;
}

}  // namespace raywalk
