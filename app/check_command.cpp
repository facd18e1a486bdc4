#include <map>

#include "app/commands.h"
#include "app/process/console.h"
#include "tracer/compiled/local_origin.h"
#include "tracer/files/load.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk {

namespace {

std::string shape_lines(const Scene& scene) {
    std::string text = "shapes: " + count_text(scene.planes.size(), "plane") + ", " +
                       count_text(scene.spheres.size(), "sphere") + ", " + count_text(scene.faces.size(), "face") +
                       ", " + count_text(scene.meshes.size(), "mesh", "meshes") + "\n";
    std::uint64_t points = 0;
    for (const Light& light : scene.lights) {
        const auto n = static_cast<std::uint64_t>(light.area ? light.area->n : 1);
        points += n * n;
    }
    return text + "lights: " + count_text(scene.lights.size(), "light") + ", " + count_text(points, "point") + "\n";
}

std::string mesh_lines(const Scene& scene, const std::map<std::filesystem::path, TriangleMesh>& files) {
    std::string text;
    for (const Mesh& mesh : scene.meshes) {
        const TriangleMesh& file = files.at(mesh.file);
        text += "mesh: " + printable(mesh.file.string()) + ", " + count_text(file.faces.size(), "triangle") + ", " +
                count_text(file.positions.size(), "vertex", "vertices") + ", " + (mesh.smooth ? "smooth" : "flat") +
                (file.normals.empty() ? "" : ", with normals") + "\n";
    }
    return text;
}

std::string image_lines(const std::map<std::filesystem::path, Image>& files) {
    std::string text;
    for (const auto& [file, image] : files)
        text += "image: " + printable(file.string()) + ", " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + " pixels\n";
    return text;
}

std::string picture_line(const Options& options, const Scene& scene) {
    const View view = opening_view(options, scene);
    return "picture: " + std::to_string(view.width) + " x " + std::to_string(view.height) + " pixels, " +
           count_text(samples_per_pixel(options, scene), "sample") + " each, " +
           (view.camera.projection == Projection::perspective ? "perspective" : "orthographic") + "\n";
}

}  // namespace

int check_command(const Options& options) {
    std::vector<Diagnostic> warnings;
    const Scene scene = read_scene(options.scene, options.limits, warnings);
    for (Diagnostic& warning : small_shape_warnings(scene)) warnings.push_back(std::move(warning));
    const auto print_warnings = [&] {
        if (options.verbosity != Verbosity::quiet) print_diagnostics(warnings);
    };
    Assets assets;
    try {
        assets = load_assets(scene, options.limits, warnings);
    } catch (const InputError&) {
        print_warnings();
        throw;
    }
    print_warnings();
    if (options.verbosity == Verbosity::quiet) return exit_done;
    print_result("scene: " + printable(scene.file.string()) + "\n" + picture_line(options, scene) + shape_lines(scene) +
                 mesh_lines(scene, assets.meshes) + image_lines(assets.images));
    return exit_done;
}

}  // namespace raywalk
