// Budgets that hostile input cannot exceed; each can be raised by an option and is named in its error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace raywalk {

struct Limits {
    std::uint64_t scene_bytes = 64ull << 20;       // a scene file
    std::uint64_t mesh_bytes = 4ull << 30;         // an OBJ file
    std::uint64_t triangles = 100'000'000;         // of all meshes together, after triangulation
    std::uint64_t light_points = 65'536;           // of all lights together: area n counts n * n
    std::uint64_t samples = 65'536;                // per pixel: dop count x anti count
    std::uint64_t image_pixels = 64ull << 20;      // of one texture
    std::uint64_t errors = 20;                     // reported before giving up
    std::vector<std::filesystem::path> allowed_folders;  // beside the parent of the scene's folder
};

}  // namespace raywalk
