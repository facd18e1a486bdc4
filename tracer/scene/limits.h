// Budgets that hostile input cannot exceed; nearly all can be raised by an option, which their error names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace raywalk {

struct Limits {
    std::uint64_t scene_bytes = 64ull << 20;        // a scene file
    std::uint64_t mesh_bytes = 4ull << 30;          // an OBJ file
    std::uint64_t triangles = 100'000'000;          // of all meshes together, after triangulation
    std::uint64_t pixels = 16ull << 20;             // of the picture: geo WIDTH x HEIGHT
    std::uint64_t light_points = 65'536;            // of all lights together: area n counts n * n
    std::uint64_t samples = 65'536;                 // per pixel: dop count x anti count
    std::uint64_t image_bytes = 1ull << 30;         // an image file
    std::uint64_t image_pixels = 64ull << 20;       // of one texture
    std::uint64_t all_image_pixels = 256ull << 20;  // of all textures together
    std::uint64_t image_pixels_per_byte = 2048;     // a small file that promises more is no picture (see read_image)
    std::uint64_t files = 1000;                     // meshes and images of a scene
    std::uint64_t memory_bytes = 0;                 // of all of it; 0: what the machine and its limits leave
    std::uint64_t seconds = 120;                    // for reading all files
    std::uint64_t image_seconds = 30;               // of processor time for one image
    std::uint64_t errors = 20;                      // reported before giving up
    std::vector<std::filesystem::path> allowed_folders;  // beside the scene's own and its project's
};

// The command-line option that raises a limit.
struct LimitOption {
    std::string_view name;  // "--max-triangles"
    std::uint64_t Limits::*value;
    std::string_view meaning;
    std::uint64_t most = std::uint64_t{1} << 53;  // that may be asked for
};

inline constexpr LimitOption limit_options[] = {
    {"--max-scene-bytes", &Limits::scene_bytes, "bytes of a scene file"},
    {"--max-mesh-bytes", &Limits::mesh_bytes, "bytes of an OBJ file"},
    {"--max-triangles", &Limits::triangles, "triangles of all meshes together"},
    {"--max-pixels", &Limits::pixels, "pixels of the picture that geo asks for (those of --size are not limited)"},
    {"--max-light-points", &Limits::light_points, "points of all lights together (area n is n x n of them)"},
    {"--max-samples", &Limits::samples, "samples per pixel (dop count x anti count)", 1 << 24},
    {"--max-image-bytes", &Limits::image_bytes, "bytes of an image file"},
    {"--max-image-pixels", &Limits::image_pixels, "pixels of one texture"},
    {"--max-all-image-pixels", &Limits::all_image_pixels, "pixels of all textures together"},
    {"--max-files", &Limits::files, "meshes and images that a scene names"},
    {"--max-memory", &Limits::memory_bytes,
     "bytes of memory for the scene (default: what the machine, its container\nand ulimit leave)"},
    {"--max-seconds", &Limits::seconds, "seconds for reading the files of a scene", 1 << 20},
    {"--max-image-seconds", &Limits::image_seconds, "seconds of processor time for one image", 1 << 20},
    {"--max-errors", &Limits::errors, "mistakes reported before giving up"},
};

// "raise the limit of 64 with --max-NAME N", for the error of a broken budget.
std::string how_to_raise(const Limits& limits, std::uint64_t Limits::*value);

// Numbers of a scene. Products of three lengths must be finite in single precision, which ends at 3.4e38: coordinates
// differ by at most 2e12 then, and the determinant of three edges stays below 6 * 8e36.
inline constexpr double largest_length = 1e12;
// Lengths that must not vanish (radii, distances): their squares are normal in single precision.
inline constexpr double smallest_length = 1e-12;
inline constexpr int largest_picture = 16'384;  // pixels on a side

}  // namespace raywalk
