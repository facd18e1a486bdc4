// Which files a scene may name: those of its own folder, of its project, and of folders that the user allows.
#pragma once

#include <filesystem>
#include <vector>

#include "tracer/ground/descriptor.h"
#include "tracer/scene/limits.h"

namespace raywalk {

class SceneFolders {
  public:
    // `scene`: its file. Its project is the parent of its folder where that looks like one (two at least of `scenes`,
    // `objs` and `textures`, or of these in the singular, lie in it, and the scene's folder is one of them), and is
    // neither the root of a file system, somebody's home, nor a folder that everybody may write to.
    SceneFolders(const std::filesystem::path& scene, const Limits& limits);

    // Whether the scene may read a file; `real` is absolute, without links.
    [[nodiscard]] bool contain(const std::filesystem::path& real) const;
    // Whether it lies in the scene's own folder or below.
    [[nodiscard]] bool are_own(const std::filesystem::path& file) const;

    // Opens a file for reading, its rights checked by what is opened: a link that comes between is refused. Throws
    // FileProblem.
    [[nodiscard]] Descriptor open(const std::filesystem::path& file) const;

  private:
    std::filesystem::path own_;
    std::vector<std::filesystem::path> roots_;
};

}  // namespace raywalk
