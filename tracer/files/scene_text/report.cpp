// Where mistakes of a scene go, and which files a scene may name.
#include <sys/stat.h>

#include <algorithm>
#include <climits>
#include <system_error>
#include <utility>

#include "tracer/files/scene_text/values.h"
#include "tracer/ground/file_bytes.h"

namespace raywalk {

Place place_of(const SceneLine& line, const Word& word) { return {line.text, line.number, word.column, word.length}; }

SourceLocation SceneReport::location(const Place& place) const {
    return {file_, place.number, place.column, place.length};
}

void SceneReport::add(std::vector<Diagnostic>& list, Diagnostic diagnostic, std::string_view line) {
    quote_line(diagnostic, line);
    list.push_back(std::move(diagnostic));
}

void SceneReport::error(const Place& place, std::string what, std::string expected) {
    if (full()) return;
    add(errors_, error_at(location(place), std::move(what), std::move(expected)), place.line);
}

void SceneReport::error_of_file(std::string what, std::string expected) {
    if (!full()) errors_.push_back(raywalk::error_of_file(file_, std::move(what), std::move(expected)));
}

void SceneReport::warning(const Place& place, std::string what, std::string expected) {
    add(warnings_, warning_at(location(place), std::move(what), std::move(expected)), place.line);
}

void SceneReport::finish(std::vector<Diagnostic>& warnings) {
    std::ranges::move(warnings_, std::back_inserter(warnings));
    if (errors_.empty()) return;
    std::ranges::stable_sort(errors_, {}, [](const Diagnostic& d) { return d.where.line; });
    if (full())
        errors_.push_back(raywalk::error_of_file(file_, "stopped after " + std::to_string(errors_.size()) + " mistakes",
                                                 "--max-errors N shows more"));
    throw InputError(std::move(errors_));
}

NamedFiles::NamedFiles(const std::filesystem::path& scene, const Limits& limits)
    : scene_(scene), folder_(scene.parent_path()), folders_(scene, limits) {}

const NamedFiles::Found& NamedFiles::find(std::string_view name) {
    const auto known = seen_.find(name);
    if (known != seen_.end()) return known->second;
    return seen_.emplace(name, look(name)).first->second;
}

NamedFiles::Found NamedFiles::look(std::string_view name) {
    if (name.empty()) return {{}, "is no file name", "expected the name of a file"};
    if (name.size() >= PATH_MAX)
        return {{}, "is too long for the name of a file", "at most " + std::to_string(PATH_MAX - 1) + " bytes"};
    const std::filesystem::path path = folder_ / std::filesystem::path(name);
    std::error_code error;
    const auto real = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    if (error) return {path, "cannot be found: " + error.message(), "a path is relative to the scene's folder"};
    if (!folders_.contain(real))
        return {path, "lies outside the folders that this scene may read",
                "allow its folder with --allow-path " + real.parent_path().string()};
    if (std::string problem = file_problem(path); !problem.empty())
        return {path, std::move(problem), "a path is relative to the scene's folder"};
    if (std::filesystem::equivalent(path, scene_, error)) return {path, "is this scene itself", "name another file"};
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return {path, {}, {}};  // gone again; its reader will say so
    return {first_names_.emplace(Identity{status.st_dev, status.st_ino}, path).first->second, {}, {}};
}

}  // namespace raywalk
