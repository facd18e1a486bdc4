#include "tracer/files/load.h"

#include <omp.h>

#include <atomic>
#include <future>
#include <limits>
#include <thread>
#include <utility>

#include "tracer/files/scene_folders.h"
#include "tracer/ground/file_bytes.h"
#include "tracer/ground/stopwatch.h"

namespace raywalk {

namespace {

void append(std::vector<Diagnostic>& to, const std::vector<Diagnostic>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// The first place that names each image file.
std::map<std::filesystem::path, SourceLocation> image_files(const Scene& scene) {
    std::map<std::filesystem::path, SourceLocation> files;
    for (const Texture* texture : textures_of(scene))
        if (const auto* image = std::get_if<ImageTexture>(&texture->pattern)) files.emplace(image->file, image->where);
    return files;
}

// Files of a scene as it may open them; one that was not read from a file may open all.
FileOpener opener_for(const Scene& scene, const Limits& limits) {
    if (scene.file.empty()) return open_file;
    return
        [folders = SceneFolders(scene.file, limits)](const std::filesystem::path& file) { return folders.open(file); };
}

// Lines of files that lie elsewhere than the scene are not shown to whoever opens it.
void withhold_foreign_lines(std::vector<Diagnostic>& diagnostics, const Scene& scene, const SceneFolders& folders) {
    for (Diagnostic& diagnostic : diagnostics) {
        if (diagnostic.where.file == scene.file || folders.are_own(diagnostic.where.file)) continue;
        diagnostic.source_line.clear();
        diagnostic.quotable = false;
    }
}

// Bytes; 0 where the file is gone.
std::uint64_t size_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    return error ? 0 : size;
}

// Throws where reading all files takes longer than it may.
void require_time(const Stopwatch& watch, const Limits& limits, const SourceLocation& where) {
    if (watch.seconds() <= static_cast<double>(limits.seconds)) return;
    throw InputError(
        error_at(where, "reading this scene's files takes more than " + std::to_string(limits.seconds) + " seconds",
                 how_to_raise(limits, &Limits::seconds)));
}

// Throws where so many files are too many.
void require_count(std::uint64_t count, const Limits& limits, const SourceLocation& where) {
    if (count <= limits.files) return;
    throw InputError(error_at(where, "a scene may name " + std::to_string(limits.files) + " files of a kind",
                              how_to_raise(limits, &Limits::files)));
}

// Throws where the images so far have too many pixels: kernels gather them by signed 32-bit indices.
void require_pixels(std::uint64_t pixels, const Limits& limits, const SourceLocation& where) {
    constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
    if (pixels <= std::min(limits.all_image_pixels, most)) return;
    throw InputError(error_at(where, "with this image the scene's images have " + std::to_string(pixels) + " pixels",
                              how_to_raise(limits, &Limits::all_image_pixels)));
}

}  // namespace

std::vector<const Texture*> textures_of(const Scene& scene) {
    std::vector<const Texture*> textures;
    for (const Plane& plane : scene.planes) textures.push_back(&plane.texture);
    for (const Sphere& sphere : scene.spheres) textures.push_back(&sphere.texture);
    for (const Face& face : scene.faces) textures.push_back(&face.texture);
    for (const Mesh& mesh : scene.meshes) textures.push_back(&mesh.texture);
    return textures;
}

SceneFiles<TriangleMesh> read_meshes(const Scene& scene, const Limits& limits, MemoryBudget& memory) {
    const Stopwatch watch;
    const FileOpener open = opener_for(scene, limits);
    SceneFiles<TriangleMesh> read;
    std::uint64_t triangles = scene.faces.size();
    try {
        for (const Mesh& mesh : scene.meshes) {
            if (!read.files.contains(mesh.file)) {
                require_count(read.files.size() + 1, limits, mesh.where);
                require_time(watch, limits, mesh.where);
                try {
                    TriangleMesh triangle_mesh = read_obj(mesh.file, limits, read.warnings, mesh.where, open);
                    if (const std::string problem = placement_problem(triangle_mesh); !problem.empty())
                        throw InputError(error_at(
                            mesh.where, "mesh " + quoted_name(mesh.file.string()) + " cannot be placed: " + problem,
                            "a mesh needs a face and two different vertices"));
                    read.files.emplace(mesh.file, std::move(triangle_mesh));
                    memory.allow_for_file(size_of(mesh.file));
                } catch (const InputError& error) {
                    append(read.errors, error.diagnostics());
                    if (read.errors.size() >= limits.errors) break;
                    read.files.emplace(mesh.file, TriangleMesh{});  // not read, and complained about, a second time
                    continue;
                }
            }
            const std::uint64_t own = read.files.at(mesh.file).faces.size();
            triangles += own;
            if (triangles > limits.triangles)
                throw InputError(error_at(mesh.where,
                                          "with this mesh the scene has " + std::to_string(triangles) +
                                              " triangles, more than the limit of " + std::to_string(limits.triangles),
                                          how_to_raise(limits, &Limits::triangles)));
            memory.take(own * (memory_of_a_triangle + (mesh.smooth ? memory_of_normals : 0)), mesh.where, "this mesh");
        }
    } catch (const InputError& error) {
        append(read.errors, error.diagnostics());
    }
    if (!scene.file.empty()) {
        const SceneFolders folders(scene.file, limits);
        withhold_foreign_lines(read.warnings, scene, folders);
        withhold_foreign_lines(read.errors, scene, folders);
    }
    read.seconds = watch.seconds();
    return read;
}

namespace {

// What an image is worth remarking on.
void note_image(const Image& image, const std::filesystem::path& file, const SourceLocation& where,
                std::vector<Diagnostic>& warnings) {
    const std::string name = "image " + quoted_name(file.string());
    if (image.width != image.height)
        warnings.push_back(warning_at(where,
                                      name + " is " + std::to_string(image.width) + " x " +
                                          std::to_string(image.height) + " pixels and is stretched over a square",
                                      "a square image keeps its shape"));
    if (image.clipped > 0)
        warnings.push_back(warning_at(where,
                                      name + " has " + std::to_string(image.clipped) +
                                          (image.clipped == 1 ? " pixel" : " pixels") +
                                          " brighter than 1, which a texture shows as 1",
                                      "scale its values to 0..1, and make up for it with brighter lights"));
}

}  // namespace

SceneFiles<Image> read_images(const Scene& scene, const Limits& limits, MemoryBudget& memory) {
    const Stopwatch watch;
    const FileOpener open = opener_for(scene, limits);
    SceneFiles<Image> read;
    const auto places = image_files(scene);
    const std::vector<std::pair<std::filesystem::path, SourceLocation>> wanted(places.begin(), places.end());

    std::vector<std::future<Image>> images(wanted.size());
    std::vector<std::promise<Image>> promises(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) images[i] = promises[i].get_future();
    std::atomic<std::size_t> next = 0;
    std::atomic<std::uint64_t> pixels = 0, failures = 0;
    std::atomic<bool> spent = false;  // a budget of all images: no more is read, which is said once
    const auto read_one = [&](std::size_t i) {
        const auto& [file, where] = wanted[i];
        if (spent) return Image{};
        try {
            require_count(i + 1, limits, where);
            require_time(watch, limits, where);
        } catch (const InputError&) {
            if (spent.exchange(true)) return Image{};
            throw;
        }
        Image image = read_image(file, limits, where, open);
        memory.allow_for_file(size_of(file));
        try {
            require_pixels(pixels += image.texels.size(), limits, where);
            memory.take(image.texels.size() * memory_of_a_texel, where, "this image");
        } catch (const InputError&) {
            if (spent.exchange(true)) return Image{};
            throw;
        }
        return image;
    };
    const auto work = [&] {
        for (std::size_t i = next++; i < wanted.size(); i = next++) try {
                promises[i].set_value(failures < limits.errors ? read_one(i) : Image{});
            } catch (...) {
                ++failures;
                promises[i].set_exception(std::current_exception());
            }
    };
    {
        std::vector<std::jthread> helpers;  // each runs one program at a time
        const auto cores = static_cast<std::size_t>(omp_get_max_threads());
        for (std::size_t i = 1; i < std::min(wanted.size(), cores); ++i) helpers.emplace_back(work);
        work();
    }

    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [file, where] = wanted[i];
        try {
            Image image = images[i].get();
            note_image(image, file, where, read.warnings);
            read.files.emplace(file, std::move(image));
        } catch (const InputError& error) {
            if (read.errors.size() < limits.errors) append(read.errors, error.diagnostics());
        }
    }
    read.seconds = watch.seconds();
    return read;
}

Assets load_assets(const Scene& scene, const Limits& limits, std::vector<Diagnostic>& warnings) {
    MemoryBudget memory(limits);
    auto images_to_come = std::async(std::launch::async, [&] { return read_images(scene, limits, memory); });
    SceneFiles<TriangleMesh> meshes = read_meshes(scene, limits, memory);
    SceneFiles<Image> images = images_to_come.get();
    append(warnings, meshes.warnings);
    append(warnings, images.warnings);
    append(meshes.errors, images.errors);
    if (!meshes.errors.empty()) throw InputError(std::move(meshes.errors));
    return {.meshes = std::move(meshes.files),
            .images = std::move(images.files),
            .mesh_seconds = meshes.seconds,
            .image_seconds = images.seconds};
}

}  // namespace raywalk
