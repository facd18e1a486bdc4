// From starting the program to its first picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/measure.h"

namespace raywalk::bench {

struct FirstPictureRow {
    std::string name;
    Spread wall, cpu;            // seconds from exec until the last tile is traced (nothing written yet)
    double parse_and_build = 0;  // CPU seconds of reading the scene's meshes and building its tree, in this process
};

// Starts `program` with `scene` a few times, one thread, and looks at its clocks when it says "100 %".
FirstPictureRow measure_first_picture(const std::filesystem::path& program, const std::filesystem::path& scene,
                                      int rounds, const std::filesystem::path& folder);

}  // namespace raywalk::bench
