// From starting the program to its first picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/measure.h"

namespace raywalk::bench {

struct FirstPictureRow {
    std::string name;
    Spread wall, cpu;  // seconds from exec until the last tile is traced (nothing written yet)
    // Of that, seconds for reading the scene and its meshes, and for building the tree (medians; one thread).
    double parse = 0, build = 0;
};

// Starts `program` with `scene` a few times, one thread, and looks at its clocks when it says "100 %".
FirstPictureRow measure_first_picture(const std::filesystem::path& program, const std::filesystem::path& scene,
                                      int rounds, const std::filesystem::path& folder);

}  // namespace raywalk::bench
