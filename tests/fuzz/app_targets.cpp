#include "tests/fuzz/app_targets.h"

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <iostream>

#include "app/command_line/options.h"
#include "app/walk/walk_script.h"
#include "tracer/files/image/image.h"

namespace raywalk::fuzz {

namespace {

void require(bool promise, const char* what) {
    if (promise) return;
    std::cerr << "broken promise: " << what << "\n";
    std::abort();
}

void check_text(std::string_view text) {
    require(!text.empty() && text.size() < 1500, "a message is there, and short");
    require(printable(text) == text || text.find('\n') != std::string_view::npos, "a message is text");
    require(text.find('\x1b') == std::string_view::npos, "a message commands no terminal");
}

void check_mistake(const InputError& error, std::size_t length) {
    require(error.diagnostics().size() == 1, "one mistake");
    const Diagnostic& mistake = error.diagnostics().front();
    require(mistake.where.column >= 1 && mistake.where.column + mistake.where.length <= length + 1, "in the script");
    check_text(to_string(mistake));
}

}  // namespace

void walk_script(std::string_view input) {
    try {
        WalkScript script = parse_walk_script(input, "--keys");
        require(script.size() <= walk_script_presses, "the budget of presses");
        script.resize(std::min<std::size_t>(script.size(), 1000), WalkKey::quit);
        const Camera camera = pressed(Camera{}, script);
        const float exposure = exposure_factor(exposure_presses(script));
        require(std::isnormal(exposure) && exposure > 0, "an exposure");
        require(std::abs(glm::length(camera.direction) - 1) < 1e-9, "a view direction");
        require(std::abs(glm::dot(camera.right, camera.north)) < 1e-9, "a level horizon");
        require(glm::length(camera.eye) <= walk_script_presses, "an eye within reach");
    } catch (const InputError& error) {
        check_mistake(error, input.size());
    }
}

void command_line(std::string_view input) {
    std::vector<std::string> words;
    while (!input.empty()) {
        const std::size_t end = std::min(input.find('\n'), input.size());
        words.emplace_back(input.substr(0, end));
        input.remove_prefix(std::min(end + 1, input.size()));
    }
    try {
        const auto parsed = parse_command_line(words);
        if (const auto* answer = std::get_if<Answer>(&parsed)) {
            require(!answer->text.empty(), "an answer");
            return;
        }
        const auto& options = std::get<Options>(parsed);
        require(!options.scene.empty(), "a scene");
        require(options.threads >= 1 && options.threads <= 1024, "threads");
        require(!options.size || (options.size->x >= 1 && options.size->y >= 1 && options.size->x <= largest_picture &&
                                  options.size->y <= largest_picture),
                "a size");
        require(!options.samples_per_pixel || *options.samples_per_pixel >= 1, "samples");
        require(!options.exposure || !options.exposure->value || *options.exposure->value > 0, "an exposure");
        const bool writes = options.mode == Mode::render || options.mode == Mode::capture;
        require(writes == is_image_extension(options.output), "a picture's name where one is written");
    } catch (const UsageError& error) {
        check_text(error.what());
    } catch (const InputError& error) {  // of --keys
        require(error.diagnostics().size() == 1, "one mistake");
        check_text(error.what());
    }
}

}  // namespace raywalk::fuzz
