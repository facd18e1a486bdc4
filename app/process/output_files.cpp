#include "app/process/output_files.h"

#include <system_error>

#include "app/process/interrupts.h"
#include "tracer/files/load.h"
#include "tracer/ground/error.h"
#include "tracer/ground/whole_file.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

bool has_output(const Options& options) { return options.mode == Mode::render || options.mode == Mode::capture; }
bool has_statistics(const Options& options) { return options.stats && *options.stats != "-"; }

void require_none(const fs::path& file, const std::string& obstacle) {
    if (!obstacle.empty()) throw WorkError("cannot write " + quoted_name(file.string()) + ": " + obstacle);
}

// Absolute, links followed, whether it is there or not yet.
fs::path real_path_of(const fs::path& file) {
    std::error_code error;
    return fs::weakly_canonical(fs::absolute(written_file(file)), error);
}

// Whether there or not yet there; devices take any number of files.
bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::exists(a, error)) return fs::is_regular_file(a, error) && fs::equivalent(a, b, error) && !error;
    return real_path_of(a) == real_path_of(b);
}

// Whether frames of the pattern ("walk-%04d.png") include the file, whatever their number.
bool is_a_frame(const std::string& pattern, const fs::path& file) {
    const fs::path real = real_path_of(file);
    if (real.parent_path() != real_path_of(fs::absolute(pattern).parent_path())) return false;
    const std::string name = real.filename().string(), wanted = fs::path(pattern).filename().string();
    const std::size_t percent = wanted.find('%'), end = wanted.find('d', percent);
    if (percent == std::string::npos || end == std::string::npos) return false;
    const std::string before = wanted.substr(0, percent), after = wanted.substr(end + 1);
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
        return false;
    const std::string_view number(name.data() + before.size(), name.size() - before.size() - after.size());
    return number.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

void require_writable_outputs(const Options& options) {
    if (has_output(options)) require_none(options.output, obstacle_to_writing_image(options.output));
    if (options.frames) require_none(*options.frames, obstacle_to_writing_image(*options.frames));
    for (const fs::path& file : {options.output, options.stats.value_or("-")})
        if (options.frames && file != "-" && is_a_frame(*options.frames, file))
            throw UsageError("--frames " + quoted_name(*options.frames) + " would overwrite " +
                             quoted_name(file.string()) + ": choose another name");
    if (!has_statistics(options)) return;
    require_none(*options.stats, obstacle_to_writing(*options.stats));
    if (has_output(options) && same_file(options.output, *options.stats))
        throw UsageError("--stats " + quoted_name(options.stats->string()) +
                         " is the picture's own name: choose another one");
}

void require_no_input(const fs::path& output, const Scene& scene) {
    std::error_code error;
    if (!fs::exists(output, error)) return;
    const auto require_other = [&](const fs::path& input, const char* kind) {
        if (same_file(output, input))
            throw UsageError(quoted_name(output.string()) + " is " + kind +
                             " and would be overwritten: choose another name");
    };
    require_other(scene.file, "the scene itself");
    for (const Mesh& mesh : scene.meshes) require_other(mesh.file, "a mesh of the scene");
    for (const Texture* texture : textures_of(scene))
        if (const auto* image = std::get_if<ImageTexture>(&texture->pattern))
            require_other(image->file, "an image of the scene");
}

void require_inputs_kept(const Options& options, const Scene& scene) {
    if (has_output(options)) require_no_input(options.output, scene);
    if (has_statistics(options)) require_no_input(*options.stats, scene);
}

Saving saving_now() { return interrupted() ? Saving::urgent : Saving::unhurried; }

}  // namespace raywalk
