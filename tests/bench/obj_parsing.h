// Reading OBJ files, against tinyobjloader and assimp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/measure.h"

namespace raywalk::bench {

struct ParseRow {
    std::string name;
    Spread seconds, cpu_seconds;  // wall time, and processor time of all threads
    std::size_t triangles = 0;
};
struct ParseTable {
    double megabytes = 0;
    std::vector<ParseRow> rows;                          // Raywalk by all threads, by one; tinyobjloader; assimp
    Spread against_tinyobj, one_thread_against_tinyobj;  // by wall time
    [[nodiscard]] bool good() const;                     // all read the same number of triangles
};

// Makes a mesh of about that size in the folder, reads it with each, and removes it.
ParseTable measure_parsing(double megabytes, int rounds, const std::filesystem::path& folder);

}  // namespace raywalk::bench
