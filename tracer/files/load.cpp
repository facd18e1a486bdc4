#include "tracer/files/load.h"

#include <atomic>
#include <future>
#include <thread>
#include <utility>

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

// `pixels` of all images so far, of which the latest has `own`. Throws where that breaks the budget.
void require_budget(std::uint64_t pixels, std::uint64_t own, const Limits& limits, const SourceLocation& where) {
    if (pixels <= limits.all_image_pixels || pixels - own > limits.all_image_pixels) return;
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

SceneFiles<TriangleMesh> read_meshes(const Scene& scene, const Limits& limits) {
    const Stopwatch watch;
    SceneFiles<TriangleMesh> read;
    std::uint64_t triangles = scene.faces.size();
    for (const Mesh& mesh : scene.meshes) {
        if (!read.files.contains(mesh.file)) {
            try {
                TriangleMesh triangle_mesh = read_obj(mesh.file, limits, read.warnings, mesh.where);
                if (const std::string problem = placement_problem(triangle_mesh); !problem.empty())
                    throw InputError(error_at(
                        mesh.where, "mesh " + quoted_name(mesh.file.string()) + " cannot be placed: " + problem,
                        "a mesh needs a face and two different vertices"));
                read.files.emplace(mesh.file, std::move(triangle_mesh));
            } catch (const InputError& error) {
                append(read.errors, error.diagnostics());
                read.files.emplace(mesh.file, TriangleMesh{});  // not read, and complained about, a second time
                continue;
            }
        }
        triangles += read.files.at(mesh.file).faces.size();
        if (triangles > limits.triangles) {
            read.errors.push_back(error_at(mesh.where,
                                           "with this mesh the scene has " + std::to_string(triangles) +
                                               " triangles, more than the limit of " + std::to_string(limits.triangles),
                                           how_to_raise(limits, &Limits::triangles)));
            break;
        }
    }
    read.seconds = watch.seconds();
    return read;
}

SceneFiles<Image> read_images(const Scene& scene, const Limits& limits) {
    const Stopwatch watch;
    SceneFiles<Image> read;
    const auto places = image_files(scene);
    const std::vector<std::pair<std::filesystem::path, SourceLocation>> wanted(places.begin(), places.end());

    std::vector<std::future<Image>> images(wanted.size());
    std::vector<std::promise<Image>> promises(wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) images[i] = promises[i].get_future();
    std::atomic<std::size_t> next = 0;
    std::atomic<std::uint64_t> pixels = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < wanted.size(); i = next++) try {
                Image image;  // none is read where the budget is spent, and that one was too many is said once
                if (pixels <= limits.all_image_pixels) {
                    image = read_image(wanted[i].first, limits, wanted[i].second);
                    require_budget(pixels += image.texels.size(), image.texels.size(), limits, wanted[i].second);
                }
                promises[i].set_value(std::move(image));
            } catch (...) {
                promises[i].set_exception(std::current_exception());
            }
    };
    {
        std::vector<std::jthread> helpers;
        const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
        for (std::size_t i = 1; i < std::min(wanted.size(), cores); ++i) helpers.emplace_back(work);
        work();
    }

    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto& [file, where] = wanted[i];
        try {
            Image image = images[i].get();
            if (image.width != image.height)
                read.warnings.push_back(
                    warning_at(where,
                               "image " + quoted_name(file.string()) + " is " + std::to_string(image.width) + " x " +
                                   std::to_string(image.height) + " pixels and is stretched over a square",
                               "a square image keeps its shape"));
            if (image.clipped > 0)
                read.warnings.push_back(warning_at(
                    where,
                    "image " + quoted_name(file.string()) + " has " + std::to_string(image.clipped) +
                        (image.clipped == 1 ? " pixel" : " pixels") + " brighter than 1, which a texture shows as 1",
                    "scale its values to 0..1, and make up for it with brighter lights"));
            read.files.emplace(file, std::move(image));
        } catch (const InputError& error) {
            append(read.errors, error.diagnostics());
        }
    }
    read.seconds = watch.seconds();
    return read;
}

}  // namespace raywalk
