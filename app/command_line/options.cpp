#include "app/command_line/options.h"

#include <algorithm>
#include <set>

#include "app/command_line/option_table.h"
#include "app/process/cores.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/spelling.h"

namespace raywalk {

namespace {

const OptionSpec* find_option(std::string_view name) {
    for (const OptionSpec& option : option_table())
        if (name == option.name || (!option.short_name.empty() && name == option.short_name)) return &option;
    return nullptr;
}

// The report's spellings of the two modes.
std::string modern(const std::string& argument) {
    for (const std::string_view word : {"-travel", "-render"})
        if (argument == word || argument.starts_with(std::string(word) + "=")) return "-" + argument;
    return argument;
}

[[noreturn]] void unknown_option(std::string_view name) {
    std::vector<std::string_view> names;
    for (const OptionSpec& option : option_table()) names.push_back(option.name);
    std::string message = "unknown option " + raywalk::quoted(name);
    if (const auto near = nearest_word(name, names)) message += ": did you mean '" + std::string(*near) + "'?";
    throw UsageError(message);
}

std::string needed_value(const OptionSpec& option) {
    std::string text =
        std::string(option.name) + " needs a value: " + std::string(option.name) + " " + std::string(option.value);
    if (option.name == "--render" || option.name == "--capture") text += ", such as picture.png";
    return text;
}

// Reads the arguments from left to right; the words that are no options end up in `words`.
CommandLine read_arguments(const std::vector<std::string>& arguments, std::vector<std::string>& words) {
    CommandLine line;
    line.options.threads = 0;
    std::set<std::string_view> seen;
    bool options_ended = false;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string argument = modern(arguments[i]);
        if (options_ended || argument.size() < 2 || argument[0] != '-') {
            words.push_back(argument);
            continue;
        }
        if (argument == "--") {
            options_ended = true;
            continue;
        }
        const std::size_t equals = argument.find('=');
        const std::string name = argument.substr(0, equals);
        const OptionSpec* option = find_option(name);
        if (option == nullptr) unknown_option(name);
        if (!seen.insert(option->name).second && !option->repeatable)
            throw UsageError(std::string(option->name) + " is given twice");

        std::string value;
        if (option->value.empty()) {
            if (equals != std::string::npos) throw UsageError(std::string(option->name) + " takes no value");
        } else if (equals != std::string::npos) {
            value = argument.substr(equals + 1);
        } else {
            // The name of another option is no value: it was forgotten.
            if (i + 1 == arguments.size() || find_option(modern(arguments[i + 1])) != nullptr)
                throw UsageError(needed_value(*option));
            value = arguments[++i];
        }
        option->apply(line, value);
    }
    return line;
}

Mode mode_of(const CommandLine& line) {
    std::vector<std::string_view> given;
    if (line.travel) given.emplace_back("-travel");
    if (line.render) given.emplace_back("-render");
    if (line.capture) given.emplace_back("--capture");
    if (line.check) given.emplace_back("--check");
    if (given.size() > 1)
        throw UsageError(std::string(given[0]) + " and " + std::string(given[1]) +
                         " exclude each other: choose one of them");
    return line.render ? Mode::render : line.capture ? Mode::capture : line.check ? Mode::check : Mode::travel;
}

void check_picture_name(std::string_view option, const std::filesystem::path& file) {
    if (is_image_extension(file)) return;
    const std::string extension = file.extension().string();
    throw UsageError(
        std::string(option) + " " + raywalk::quoted(file.string()) + ": " +
        (extension.empty() ? "the name has no extension" : "unknown kind of picture " + raywalk::quoted(extension)) +
        "; use .png .jpg .exr .pfm .hdr .tif");
}

// One %d (or %4d, %04d) and no other %.
bool is_frame_pattern(std::string_view pattern) {
    int numbers = 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') continue;
        ++i;
        std::size_t digits = 0;
        while (i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9') ++i, ++digits;
        if (digits > 2 || i == pattern.size() || pattern[i] != 'd') return false;
        ++numbers;
    }
    return numbers == 1;
}

void check_frames(const Options& options) {
    if (!options.frames) return;
    if (options.mode != Mode::capture) throw UsageError("--frames writes the frames of --capture: add --capture OUT");
    if (options.keys.empty()) throw UsageError("--frames writes one frame per key: add --keys SCRIPT");
    if (!is_frame_pattern(*options.frames))
        throw UsageError("--frames " + raywalk::quoted(*options.frames) +
                         ": expected one number in the name, as in walk-%04d.png");
    check_picture_name("--frames", *options.frames);
}

void check_accelerator(CommandLine& line) {
    if (!line.kd_option_given) return;
    if (line.accelerator_given && line.options.compile.accelerator != Accelerator::kdtree)
        throw UsageError(
            "--leaf-limit, --depth-limit, --traversal-cost and --intersection-cost shape the kd-tree: "
            "use --accelerator kdtree with them");
    line.options.compile.accelerator = Accelerator::kdtree;
}

}  // namespace

std::variant<Options, Answer> parse_command_line(const std::vector<std::string>& arguments) {
    std::vector<std::string> words;
    CommandLine line = read_arguments(arguments, words);
    if (line.help) return Answer{help_text()};
    if (line.version) return Answer{std::string("raywalk ") + RAYWALK_VERSION + "\n"};

    Options& options = line.options;
    options.mode = mode_of(line);
    if (line.quiet && line.verbose) throw UsageError("--quiet and --verbose exclude each other: choose one of them");
    options.verbosity = line.quiet ? Verbosity::quiet : line.verbose ? Verbosity::verbose : Verbosity::normal;
    if (words.empty() || words[0].empty())
        throw UsageError("which scene? Name a scene file, such as scenes/cornell_box.scene");
    if (words.size() > 1) throw UsageError("one scene at a time: what is " + raywalk::quoted(words[1]) + " for?");
    options.scene = words[0];

    if (options.mode == Mode::render) check_picture_name("-render", options.output);
    if (options.mode == Mode::capture) check_picture_name("--capture", options.output);
    if (options.mode == Mode::check && options.stats)
        throw UsageError("--stats measures a picture, and --check makes none: leave one of them out");
    check_frames(options);
    check_accelerator(line);
    if (options.size) options.limits.pixels = ~std::uint64_t{0};  // the scene's own size does not matter then
    if (options.threads == 0) options.threads = usable_cores();
    return std::move(options);
}

}  // namespace raywalk
