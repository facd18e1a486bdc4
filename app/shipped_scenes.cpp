#include "app/shipped_scenes.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

bool is_mesh(const fs::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".obj";
}

[[noreturn]] void refuse_mesh(const fs::path& file) {
    throw InputError(
        error_of_file(file.string(), "a mesh is no scene, which says how it is seen and lit",
                      "name it in a scene, in a Mesh block: copy the scene teapot and change its line to `file \"" +
                          printable(file.filename().string()) + "\"`"));
}

}  // namespace

fs::path scene_file(const fs::path& scene) {
    std::error_code error;
    if (fs::exists(scene, error)) {
        if (is_mesh(scene) && !fs::is_directory(scene, error)) refuse_mesh(scene);
        return scene;
    }
    if (scene.has_parent_path()) return scene;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    if (error) return scene;
    fs::path name = scene;
    if (name.extension() != ".scene") name += ".scene";
    // As installed, and as built in build/PRESET.
    for (const char* folder : {"../share/raywalk/scenes", "../../scenes"})
        if (const fs::path shipped = program / folder / name; fs::is_regular_file(shipped, error))
            return shipped.lexically_normal();
    return scene;
}

}  // namespace raywalk
