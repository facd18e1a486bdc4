// The command line is read by CLI11; what its words must be, and what is said of those that are not, stands here.
#include "app/command_line/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/command_line/help.h"
#include "app/process/cores.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/spelling.h"
#include "tracer/kernels/kernels.h"

namespace raywalk {

namespace {

// Readers of values: from the word and the option's name to the value; they throw UsageError.

[[noreturn]] void wrong_value(std::string_view option, const std::string& value, const std::string& expected) {
    throw UsageError(std::string(option) + ": expected " + expected + ", not " + raywalk::quoted(value));
}

// CLI11's own reader of numbers takes " 1", and 010 for eight.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
    return number;
}

template <class Integer>
auto whole_number(Integer lowest, Integer highest) {
    return [=](const std::string& value, std::string_view option) {
        const auto number = number_of<Integer>(value);
        if (!number || *number < lowest || *number > highest)
            wrong_value(option, value,
                        "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
        return *number;
    };
}

auto positive(const char* expected) {
    return [=](const std::string& value, std::string_view option) {
        const auto number = number_of<float>(value);
        if (!number || !std::isnormal(*number) || *number < 0) wrong_value(option, value, expected);
        return *number;
    };
}

Exposure exposure(const std::string& value, std::string_view option) {
    if (value == "normalize") return {};
    return {positive("'normalize' or a number above 0 such as 1.5")(value, option)};
}

glm::ivec2 size_in_pixels(const std::string& value, std::string_view option) {
    const std::size_t cross = std::min(value.find_first_of("xX"), value.size());
    const std::string_view text = value;
    const auto width = number_of<int>(text.substr(0, cross));
    const auto height = number_of<int>(text.substr(std::min(cross + 1, text.size())));
    const auto in_range = [](int pixels) { return pixels >= 1 && pixels <= largest_picture; };
    if (!width || !height || !in_range(*width) || !in_range(*height))
        wrong_value(option, value,
                    "WIDTHxHEIGHT in pixels such as 1280x720, each from 1 to " + std::to_string(largest_picture));
    return {*width, *height};
}

// One of a few words, as what it stands for.
template <class Meaning>
auto one_of(std::vector<std::pair<std::string_view, Meaning>> meanings) {
    return [meanings](const std::string& value, std::string_view option) {
        std::vector<std::string_view> words;
        for (const auto& [word, meaning] : meanings) {
            if (word == value) return meaning;
            words.push_back(word);
        }
        std::string message =
            std::string(option) + ": expected one of " + listed(words) + ", not " + raywalk::quoted(value);
        if (const std::string meant = did_you_mean(value, words); !meant.empty()) message += ": " + meant;
        throw UsageError(message);
    };
}

std::string instruction_set(const std::string& value, std::string_view option) {
    std::vector<std::string_view> names;
    for (const Kernels* kernels : available_kernels()) names.push_back(kernels->name);
    if (std::find(names.begin(), names.end(), value) != names.end()) return value;
    throw UsageError(std::string(option) + ": this processor has no " + raywalk::quoted(value) + ", but " +
                     listed(names));
}

std::string picture_name(const std::string& value, std::string_view option) {
    if (is_image_extension(value)) return value;
    const std::string extension = std::filesystem::path(value).extension().string();
    throw UsageError(
        std::string(option) + " " + raywalk::quoted(value) + ": " +
        (extension.empty() ? "the name has no extension" : "unknown kind of picture " + raywalk::quoted(extension)) +
        "; use .png .jpg .exr .pfm .hdr .tif");
}

// One %d (or %4d, %04d) and no other %.
std::string frame_pattern(const std::string& value, std::string_view option) {
    int numbers = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (value[i] != '%') continue;
        const std::size_t end = std::min(value.find_first_not_of("0123456789", i + 1), value.size());
        numbers += end - i <= 3 && value[end] == 'd' ? 1 : 2;
        i = end;
    }
    if (numbers != 1)
        throw UsageError(std::string(option) + " " + raywalk::quoted(value) +
                         ": expected one number in the name, as in walk-%04d.png");
    return picture_name(value, option);
}

struct HelpFormatter : CLI::Formatter {
    std::string make_usage(const CLI::App*, std::string) const override { return help_start; }
};

struct CommandLine {
    Options options;
    std::string scene;
    CLI::App app;

    CommandLine();
    void parse(const std::vector<std::string>& arguments);
    void check_words(const std::vector<std::string>& arguments) const;
    void check_accelerator();

    void group(const char* title) { app.option_defaults()->group(title); }
    [[nodiscard]] bool given(const char* name) const { return app.count(name) > 0; }
    CLI::Option* flag(const std::string& names, const std::string& help, std::function<void()> set);
    template <class Target, class Read>
    CLI::Option* value(const std::string& name, const char* placeholder, const std::string& help, Target& target,
                       Read read);
    [[noreturn]] void value_forgotten(std::string_view option) const;
    [[noreturn]] void unknown_option(std::string_view name) const;
};

CLI::Option* CommandLine::flag(const std::string& names, const std::string& help, std::function<void()> set) {
    return app.add_flag_callback(names, std::move(set), help)
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
        ->option_text(" ");  // rather than which options it excludes
}

template <class Target, class Read>
CLI::Option* CommandLine::value(const std::string& name, const char* placeholder, const std::string& help,
                                Target& target, Read read) {
    const auto take = [this, name, &target, read](const CLI::results_t& words) {
        for (const std::string& word : words) {
            // The name of another option is no value: it was forgotten.
            if (word.starts_with('-') && app.get_option_no_throw(word) != nullptr) value_forgotten(name);
            if constexpr (requires { target.emplace_back(word); } && !std::is_same_v<Target, WalkScript>)
                target.emplace_back(read(word, name));
            else
                target = read(word, name);
        }
        return true;
    };
    return app.add_option(name, take, help)->option_text(placeholder);
}

CommandLine::CommandLine() {
    app.allow_extras();  // and told what they may have been meant to be: see check_words
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(27);
    app.footer(help_end);
    CompileOptions& compile = options.compile;
    options.threads = 0;
    app.add_option("SCENE", scene)->group("");  // help tells of it in its first lines

    group("what to do");
    const auto picture_of = [this](Mode mode) {
        return [this, mode](const std::string& name, std::string_view option) {
            options.mode = mode;
            return picture_name(name, option);
        };
    };
    const std::vector<CLI::Option*> modes = {
        flag("--travel", "walk through the scene in a window (the default); also -travel", [] {}),
        value("--render", "OUT",
              "render once and write OUT: .png .jpg hold display values,\n"
              ".exr .pfm .hdr .tif linear radiance; also -render",
              options.output, picture_of(Mode::render)),
        value("--capture", "OUT",
              "no window: press --keys, accumulate --spp samples,\n"
              "write what the window would show",
              options.output, picture_of(Mode::capture)),
        flag("--check", "read the scene with its meshes and images, say what it holds,\nrender nothing",
             [this] { options.mode = Mode::check; }),
    };
    for (CLI::Option* mode : modes)
        for (CLI::Option* other : modes)
            if (mode != other) mode->excludes(other);

    group("the picture");
    value("--size", "WxH", "size of the picture in pixels (else the scene's geo)", options.size, size_in_pixels);
    // Counts above 2^24 are not exact in single precision.
    value("--spp", "N", "samples per pixel (else the scene's dop count x anti count, else 1)",
          options.samples_per_pixel, whole_number<std::uint32_t>(1, 1u << 24));
    value("--projection", "NAME", "perspective or orthographic (else the scene's choice)", options.projection,
          one_of<Projection>({{"perspective", Projection::perspective}, {"orthographic", Projection::orthographic}}));
    value("--exposure", "VALUE",
          "'normalize' darkens the picture until nothing is over 1 (the default);\n"
          "a number multiplies and clips",
          options.exposure, exposure);
    value("--seed", "N", "seed of every random choice (default 0)", options.seed, whole_number<std::uint32_t>(0, ~0u));

    group("walking by script");
    value("--keys", "SCRIPT",
          "keys of the walk to press first: '12w 3R t ]' is 12 steps forward,\n"
          "3 turns to the right, the other projection, brighter",
          options.keys, parse_walk_script);
    value("--frames", "PATTERN", "with --capture: also write the frame after every key, as walk-%04d.png",
          options.frames, frame_pattern)
        ->needs(modes[2]);

    group("messages");
    value("--stats", "FILE", "write scene counts, times, rays, rays per second, the tree,\nas JSON ('-': stdout)",
          options.stats, [](const std::string& name, std::string_view) { return name; });
    flag("-q,--quiet", "say nothing but errors", [this] {
        options.verbosity = Verbosity::quiet;
    })->excludes(flag("-v,--verbose", "say more: times of loading and building, threads, instruction set", [this] {
        options.verbosity = Verbosity::verbose;
    }));
    app.set_help_flag("-h,--help", "show this help");
    app.set_version_flag("--version", std::string("raywalk ") + RAYWALK_VERSION, "show the version");

    group("speed");
    value("--threads", "N", "threads (default: every core this process may use)", options.threads,
          whole_number(1, most_threads));
    value("--accelerator", "NAME", "bvh (default) or kdtree: same picture, another way to find hits",
          compile.accelerator, one_of<Accelerator>({{"kdtree", Accelerator::kdtree}, {"bvh", Accelerator::bvh}}));
    value("--isa", "NAME", "instruction set of the kernels (default: the best of this processor)", options.isa,
          instruction_set);
    value("--leaf-limit", "N", "kd-tree: so many shapes or fewer always make a leaf (default 16)",
          compile.kd.leaf_limit, whole_number(1, 1024));
    value("--depth-limit", "N", "kd-tree: deepest level (default 8 + 1.6 log2 of the shapes)", compile.kd.depth_limit,
          whole_number<int>(1, KdTree::max_depth));
    value("--traversal-cost", "KT", "kd-tree: cost of visiting a node", compile.kd.traversal_cost,
          positive("a number above 0 such as 0.75"));
    value("--intersection-cost", "KI", "kd-tree: cost of testing a block of 16 shapes", compile.kd.intersection_cost,
          positive("a number above 0 such as 1.0"));

    group("limits, against hostile scenes");
    value("--allow-path", "DIR",
          "a folder that scenes may name files in, beside their own and those of\n"
          "their project; may be given several times",
          options.limits.allowed_folders, [](const std::string& name, std::string_view) { return name; })
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    for (const LimitOption& limit : limit_options)
        value(std::string(limit.name), "N", std::string(limit.meaning), options.limits.*limit.value,
              whole_number<std::uint64_t>(1, limit.most));
}

void CommandLine::value_forgotten(std::string_view option) const {
    const std::string name(option);
    throw UsageError(name + " needs a value: " + name + " " + app.get_option(name)->get_option_text() +
                     (name == "--render" || name == "--capture" ? ", such as picture.png" : ""));
}

void CommandLine::unknown_option(std::string_view name) const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string meant = did_you_mean(name, known);
    throw UsageError("unknown option " + raywalk::quoted(name) + (meant.empty() ? "" : ": " + meant));
}

// What CLI11 would take for something else: the report's -render and -travel, and the values of --quiet=no and --size=.
std::vector<std::string> rewritten(const std::vector<std::string>& arguments, const CLI::App& app) {
    std::vector<std::string> words;
    for (auto argument = arguments.begin(); argument != arguments.end(); ++argument) {
        if (*argument == "--") {
            words.insert(words.end(), argument, arguments.end());
            break;
        }
        const std::size_t equals = argument->find('=');
        std::string name = argument->substr(0, equals);
        if (name == "-render" || name == "-travel") name.insert(0, "-");
        const CLI::Option* option = name.starts_with("--") ? app.get_option_no_throw(name) : nullptr;
        if (option == nullptr) {
            words.push_back(*argument);
            continue;
        }
        words.push_back(name);
        if (equals == std::string::npos) continue;
        if (option->get_items_expected_max() == 0) throw UsageError(name + " takes no value");
        words.push_back(argument->substr(equals + 1));
    }
    return words;
}

void CommandLine::parse(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = rewritten(arguments, app);
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    try {
        app.parse(std::vector(words));
    } catch (const CLI::ExcludesError& error) {
        throw UsageError(error.what() + std::string(": choose one of them"));
    } catch (const CLI::ArgumentMismatch&) {
        for (const CLI::Option* option : app.get_options())
            if (option->count() > 1 && option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw)
                throw UsageError(option->get_name() + " is given twice");
        value_forgotten(words.front());
    } catch (const CLI::RequiresError& error) {
        throw UsageError(error.what());
    }
    check_words(arguments);
    check_accelerator();
}

// Of what CLI11 has taken for the scene, and of what it has found no use for.
void CommandLine::check_words(const std::vector<std::string>& arguments) const {
    const std::vector<std::string> rest = app.remaining();
    const auto options_end = std::find(rest.begin(), rest.end(), "--");
    for (auto word = rest.begin(); word != options_end; ++word) {
        if (!word->starts_with('-') || *word == "-") continue;
        // "-vx" has been taken apart, and only "-x" is left.
        const auto whole = std::find_if(arguments.begin(), arguments.end(), [&](const std::string& argument) {
            return argument.starts_with('-') && argument.ends_with(std::string_view(*word).substr(1));
        });
        unknown_option(std::string_view(whole == arguments.end() ? *word : *whole).substr(0, word->find('=')));
    }
    const bool ended = std::find(arguments.begin(), arguments.end(), "--") != arguments.end();
    if (scene.starts_with('-') && scene != "-" && !ended) unknown_option(scene);
    if (scene.empty()) throw UsageError("which scene? Name a scene file, such as scenes/cornell_box.scene");
    for (const std::string& word : rest)
        if (word != "--") throw UsageError("one scene at a time: what is " + raywalk::quoted(word) + " for?");
}

void CommandLine::check_accelerator() {
    if (!given("--leaf-limit") && !given("--depth-limit") && !given("--traversal-cost") &&
        !given("--intersection-cost"))
        return;
    if (given("--accelerator") && options.compile.accelerator != Accelerator::kdtree)
        throw UsageError(
            "--leaf-limit, --depth-limit, --traversal-cost and --intersection-cost shape the kd-tree: "
            "use --accelerator kdtree with them");
    options.compile.accelerator = Accelerator::kdtree;
}

}  // namespace

std::variant<Options, Answer> parse_command_line(const std::vector<std::string>& arguments) {
    CommandLine line;
    try {
        line.parse(arguments);
    } catch (const CLI::CallForHelp&) {
        return Answer{CLI::detail::find_and_replace(line.app.help(), "\n\n\n", "\n\n")};
    } catch (const CLI::CallForVersion&) {
        return Answer{line.app.version() + "\n"};
    }
    Options& options = line.options;
    options.scene = line.scene;
    if (options.mode == Mode::check && options.stats)
        throw UsageError("--stats measures a picture, and --check makes none: leave one of them out");
    if (options.frames && options.keys.empty())
        throw UsageError("--frames writes one frame per key: add --keys SCRIPT");
    if (options.size) options.limits.pixels = ~std::uint64_t{0};  // the scene's own size does not matter then
    if (options.threads == 0) options.threads = usable_cores();
    return std::move(options);
}

}  // namespace raywalk
