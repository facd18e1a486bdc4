// Scenes by name: those that ship with the program.
#pragma once

#include <filesystem>

namespace raywalk {

// The file of SCENE on the command line: that file, or where there is none the shipped scene of that name
// ("cornell_box"), of the installed program (../share/raywalk/scenes from it) or of the project that it was built in.
// Throws InputError for a mesh, which is no scene, with what to do.
std::filesystem::path scene_file(const std::filesystem::path& scene);

}  // namespace raywalk
