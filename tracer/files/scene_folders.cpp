#include "tracer/files/scene_folders.h"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "tracer/ground/error.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/ground/open_beneath.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

// Absolute and without links, as far as there is anything.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path.empty() ? "." : path, error);
    fs::path real = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : real;
}

bool lies_in(const fs::path& folder, const fs::path& real) {
    return std::ranges::mismatch(folder, real).in1 == folder.end();
}

bool is_home(const fs::path& folder) {
    std::error_code error;
    const char* home = std::getenv("HOME");
    if (home != nullptr && fs::equivalent(folder, home, error)) return true;
    const passwd* user = getpwuid(geteuid());
    if (user != nullptr && user->pw_dir != nullptr && fs::equivalent(folder, user->pw_dir, error)) return true;
    return folder.parent_path() == "/home";  // of others
}

bool is_project(const fs::path& parent, const fs::path& folder) {
    constexpr std::array<const char*, 6> names = {"scenes", "objs", "textures", "scene", "obj", "texture"};
    if (std::ranges::find(names, folder.filename()) == names.end()) return false;
    std::error_code error;
    if (std::ranges::count_if(names, [&](const char* name) { return fs::is_directory(parent / name, error); }) < 2)
        return false;
    struct stat status {
    }, above{};
    if (stat(parent.c_str(), &status) != 0 || stat((parent / "..").c_str(), &above) != 0) return false;
    const bool root = status.st_dev != above.st_dev || status.st_ino == above.st_ino;
    return !root && (status.st_mode & S_IWOTH) == 0 && !is_home(parent);
}

}  // namespace

SceneFolders::SceneFolders(const fs::path& scene, const Limits& limits) : own_(real_path(scene.parent_path())) {
    // A scene that lies in the root has the whole machine below it.
    if (own_ != own_.root_path()) roots_.push_back(own_);
    if (const fs::path parent = own_.parent_path(); is_project(parent, own_)) roots_.push_back(parent);
    for (const fs::path& allowed : limits.allowed_folders) roots_.push_back(real_path(allowed));
}

bool SceneFolders::contain(const fs::path& real) const {
    return std::ranges::any_of(roots_, [&](const fs::path& root) { return lies_in(root, real); });
}

bool SceneFolders::are_own(const fs::path& file) const { return lies_in(own_, real_path(file)); }

Descriptor SceneFolders::open(const fs::path& file) const {
    const fs::path real = real_path(file);
    const auto root = std::ranges::find_if(roots_, [&](const fs::path& folder) { return lies_in(folder, real); });
    if (root == roots_.end()) throw FileProblem("lies outside the folders that this scene may read");
    const Descriptor folder(::open(root->c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    Descriptor opened;
    if (folder.valid()) opened = open_beneath(folder, real.lexically_relative(*root));
    if (opened.valid()) return opened;
    if (errno == ELOOP || errno == EXDEV) throw FileProblem("changed while it was read; try again");
    throw unopened(file, errno);
}

}  // namespace raywalk
