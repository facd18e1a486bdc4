// From a scene to its assets: the meshes and images that it names, each file read once however often it is named.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "tracer/files/image/image.h"
#include "tracer/files/memory_budget.h"
#include "tracer/files/mesh/obj_reader.h"
#include "tracer/scene/limits.h"
#include "tracer/scene/scene.h"

namespace raywalk {

// Files read and what they are worth remarking on. Wrong files are in `errors`, and only then missing from `files`.
template <class File>
struct SceneFiles {
    std::map<std::filesystem::path, File> files;
    std::vector<Diagnostic> warnings, errors;
    double seconds = 0;
};

// Meshes are read one after the other, each by all threads, and can be placed; images at the same time as each other.
// Never throw InputError: a scene with several wrong files hears of all of them, up to limits.errors. What they and the
// tree over them will take is counted in `memory`.
SceneFiles<TriangleMesh> read_meshes(const Scene& scene, const Limits& limits, MemoryBudget& memory);
SceneFiles<Image> read_images(const Scene& scene, const Limits& limits, MemoryBudget& memory);

// What a scene needs beside itself.
struct Assets {
    std::map<std::filesystem::path, TriangleMesh> meshes;
    std::map<std::filesystem::path, Image> images;
    double mesh_seconds = 0, image_seconds = 0;
};

// All of it, images while meshes are read. Throws InputError with what is wrong with any file.
Assets load_assets(const Scene& scene, const Limits& limits, std::vector<Diagnostic>& warnings);

// Every texture of the scene, in the order planes, spheres, faces, meshes.
std::vector<const Texture*> textures_of(const Scene& scene);

}  // namespace raywalk
