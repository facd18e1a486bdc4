// Scene -> CompiledScene: the one place that sees both.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "tracer/compiled/compile.h"
#include "tracer/compiled/local_origin.h"
#include "tracer/compiled/mesh_placement.h"
#include "tracer/ground/numeric.h"

namespace raywalk {

namespace {

// Surfaces by value: shapes that look the same share a record.
class SurfaceTable {
  public:
    // `image_indices`: each image file's index in CompiledScene::images.
    explicit SurfaceTable(std::map<std::filesystem::path, std::int32_t> image_indices)
        : image_indices_(std::move(image_indices)) {}

    std::int32_t index_of(const Texture& texture) {
        const SurfaceRecord record = record_of(texture);
        std::string key(sizeof record, '\0');
        std::memcpy(key.data(), &record, sizeof record);  // every byte is a member's
        const auto [place, is_new] = indices_.emplace(std::move(key), static_cast<std::int32_t>(records.size()));
        if (is_new) records.push_back(record);
        return place->second;
    }

    AlignedVector<SurfaceRecord> records;

  private:
    [[nodiscard]] SurfaceRecord record_of(const Texture& texture) const {
        SurfaceRecord record{};
        record.ambient = static_cast<float>(texture.material.ambient);
        record.specular = static_cast<float>(texture.material.specular);
        record.reflection = static_cast<float>(texture.material.reflection);
        record.transmission = static_cast<float>(texture.material.transmission);
        record.shininess = texture.material.shininess;
        if (const auto* pure = std::get_if<PureTexture>(&texture.pattern)) {
            record.pattern = Pattern::pure;
            for (int channel = 0; channel < 3; ++channel)
                record.color[channel] = static_cast<float>(pure->color[channel]);
        } else if (const auto* grid = std::get_if<GridTexture>(&texture.pattern)) {
            record.pattern = Pattern::grid;
            record.scale = static_cast<float>(grid->density);
        } else if (const auto* image = std::get_if<ImageTexture>(&texture.pattern)) {
            record.pattern = Pattern::image;
            record.scale = 1.0f / static_cast<float>(image->size);
            record.image = image_indices_.at(image->file);
        }
        return record;
    }

    std::map<std::filesystem::path, std::int32_t> image_indices_;
    std::unordered_map<std::string, std::int32_t> indices_;
};

// Image file -> index, in the order of their names.
std::map<std::filesystem::path, std::int32_t> image_indices(const std::map<std::filesystem::path, Image>& images) {
    std::map<std::filesystem::path, std::int32_t> indices;
    for (const auto& [file, image] : images) indices.emplace(file, static_cast<std::int32_t>(indices.size()));
    return indices;
}

void copy(const glm::vec3& from, float (&to)[3]) {
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

// The axes of the surface coordinates of a plane (spec 4.6). For the six normals along an axis they are the spec's;
// for others those of the nearest axis, turned by the least rotation that takes the axis to the normal.
void set_plane_axes(const glm::dvec3& normal, PlaneRecord& record) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
    glm::dvec3 nearest(0);
    nearest[axis] = std::copysign(1.0, normal[axis]);

    const auto or_else = [](const glm::dvec3& v, const glm::dvec3& instead) {
        return v == glm::dvec3(0) ? instead : v;
    };
    const glm::dvec3 instead(-nearest.z, 0, nearest.x);
    const glm::dvec3 u = or_else({-nearest.y, nearest.x, 0}, instead), v = or_else({0, -nearest.z, nearest.y}, instead);
    // The rotation that takes the unit vector e to n takes a vector w across e to w - (w.n) / (1 + e.n) (e + n).
    const auto turned = [&](const glm::dvec3& w) {
        return w - (nearest + normal) * (glm::dot(w, normal) / (1 + glm::dot(nearest, normal)));
    };
    copy(turned(u), record.u_axis);
    copy(turned(v), record.v_axis);
}

// Where the texture's pattern begins again, in both coordinates: whole numbers, as densities and sizes are.
double period_of(const Texture& texture) {
    const auto* image = std::get_if<ImageTexture>(&texture.pattern);
    return image != nullptr ? image->size : 2.0;
}

void compile_planes(const Scene& scene, SurfaceTable& surfaces, CompiledScene& compiled) {
    for (const Plane& plane : scene.planes) {
        PlaneRecord record{};
        copy(plane.normal, record.normal);
        record.offset = limited(plane.offset);
        record.surface = surfaces.index_of(plane.texture);
        set_plane_axes(plane.normal, record);
        const auto along = [&](const float(&axis)[3]) {
            const double shift = glm::dot(compiled.origin, glm::dvec3(axis[0], axis[1], axis[2]));
            return static_cast<float>(std::fmod(shift, period_of(plane.texture)));
        };
        record.shift[0] = along(record.u_axis);
        record.shift[1] = along(record.v_axis);
        compiled.planes.push_back(record);
    }
    compiled.plane_count = static_cast<std::int32_t>(compiled.planes.size());
}

void compile_spheres(const Scene& scene, SurfaceTable& surfaces, CompiledScene& compiled,
                     std::vector<SphereShape>& shapes) {
    for (const Sphere& sphere : scene.spheres) {
        SphereRecord record{};
        copy(limited(sphere.center), record.center);
        record.radius = limited(sphere.radius);
        record.refraction_index = static_cast<float>(sphere.refraction_index);
        record.surface = surfaces.index_of(sphere.texture);
        compiled.spheres.push_back(record);
        shapes.push_back({.center = limited(sphere.center), .radius = record.radius});
    }
    compiled.sphere_count = static_cast<std::int32_t>(compiled.spheres.size());
}

// Where the triangles of one mesh go.
struct MeshSpan {
    const Mesh* mesh;
    const TriangleMesh* triangles;
    std::size_t first;
};

void compile_mesh(const MeshSpan& span, std::int32_t surface, CompiledScene& compiled,
                  std::vector<TriangleCorners>& corners) {
    const std::vector<glm::vec3> positions = placed_positions(*span.triangles, span.mesh->center, span.mesh->radius);
    const auto& faces = span.triangles->faces;
#pragma omp parallel for schedule(static) if (faces.size() >= worth_threads)
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& [a, b, c] = faces[f];
        corners[span.first + f] = {{positions[a], positions[b], positions[c]}};
        TriangleRecord& record = compiled.triangles[span.first + f];
        copy(geometric_normal(positions[a], positions[b], positions[c]), record.normal);
        record.surface = surface;
    }
    if (!span.mesh->smooth) return;
    corner_normals(*span.triangles, {compiled.vertex_normals.data() + span.first, faces.size()});
}

// Smooth meshes, flat meshes, faces: in this order, so that the smooth triangles are the first.
void compile_triangles(const Scene& scene, const std::map<std::filesystem::path, TriangleMesh>& files,
                       SurfaceTable& surfaces, CompiledScene& compiled, std::vector<TriangleCorners>& corners) {
    std::vector<MeshSpan> spans;
    std::size_t count = 0, smooth_count = 0;
    for (const bool smooth : {true, false}) {
        for (const Mesh& mesh : scene.meshes) {
            if (mesh.smooth != smooth) continue;
            const TriangleMesh& file = files.at(mesh.file);
            spans.push_back({&mesh, &file, count});
            count += file.faces.size();
        }
        if (smooth) smooth_count = count;
    }
    compiled.smooth_count = static_cast<std::int32_t>(smooth_count);
    compiled.triangle_count = static_cast<std::int32_t>(count + scene.faces.size());
    compiled.vertex_normals.resize(smooth_count);
    compiled.triangles.resize(count + scene.faces.size());
    corners.resize(count + scene.faces.size());

    for (const MeshSpan& span : spans) compile_mesh(span, surfaces.index_of(span.mesh->texture), compiled, corners);
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
        const Face& face = scene.faces[f];
        const glm::vec3 a = limited(face.a), b = limited(face.b), c = limited(face.c);
        corners[count + f] = {{a, b, c}};
        copy(geometric_normal(a, b, c), compiled.triangles[count + f].normal);
        compiled.triangles[count + f].surface = surfaces.index_of(face.texture);
    }
    compiled.smooth_corners.assign(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(smooth_count));
    const auto note_error = [&](std::int32_t surface, double reach) {
        float& error = surfaces.records[static_cast<std::size_t>(surface)].triangle_error;
        error = std::max(error, static_cast<float>(reach) * triangle_offset);
    };
    const auto farthest = [](const glm::dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
    for (const Mesh& mesh : scene.meshes)
        note_error(surfaces.index_of(mesh.texture), farthest(mesh.center) + mesh.radius);
    for (const Face& face : scene.faces)
        for (const glm::dvec3& corner : {face.a, face.b, face.c})
            note_error(surfaces.index_of(face.texture), farthest(corner));
}

// Radiance that sums of many samples can hold in single precision.
constexpr double radiance_limit = 1e18;

void compile_light(const Light& light, CompiledScene& compiled) {
    const int n = light.area ? light.area->n : 1;
    const double radius = light.area ? light.area->radius : 0;
    const double intensity = light.intensity / (static_cast<double>(n) * n);
    const auto first = static_cast<std::uint32_t>(compiled.light_points.size());
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / n;
            const glm::dvec3 offset(std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b));
            LightPoint point{};
            copy(limited(light.origin + radius * offset), point.position);
            for (int channel = 0; channel < 3; ++channel)
                point.radiance[channel] =
                    static_cast<float>(std::clamp(light.color[channel] * intensity, -radiance_limit, radiance_limit));
            compiled.light_points.push_back(point);
        }
    compiled.light_groups.push_back({first, static_cast<std::uint32_t>(n) * static_cast<std::uint32_t>(n)});
}

void compile_images(std::map<std::filesystem::path, Image>& files, CompiledScene& compiled) {
    std::size_t texels = 0;
    for (const auto& [file, image] : files) texels += image.texels.size();
    compiled.texels.reserve(texels);
    for (auto& [file, image] : files) {
        compiled.images.push_back({static_cast<std::uint32_t>(compiled.texels.size()), image.width, image.height});
        compiled.texels.insert(compiled.texels.end(), image.texels.begin(), image.texels.end());
        image = {};  // so that most are held once only
    }
    // Gathers of lanes without an image read the first texel of the first one.
    if (compiled.images.empty()) compiled.images.emplace_back();
    if (compiled.texels.empty()) compiled.texels.push_back(0);
}

}  // namespace

CompiledScene compile(const Scene& given, Assets assets, const CompileOptions& options, BuildStatistics* statistics) {
    const glm::dvec3 origin = local_origin(given);
    std::optional<Scene> moved;
    if (origin != glm::dvec3(0)) moved = moved_to(origin, given);
    const Scene& scene = moved ? *moved : given;
    CompiledScene compiled;
    compiled.origin = origin;
    for (const Light& light : scene.lights) compile_light(light, compiled);

    SurfaceTable surfaces(image_indices(assets.images));
    std::vector<TriangleCorners> corners;
    std::vector<SphereShape> spheres;
    compile_triangles(scene, assets.meshes, surfaces, compiled, corners);
    assets.meshes.clear();
    compile_spheres(scene, surfaces, compiled, spheres);
    compile_planes(scene, surfaces, compiled);
    compiled.surfaces = std::move(surfaces.records);
    if (compiled.surfaces.empty()) compiled.surfaces.push_back(SurfaceRecord{});  // gathers read the first
    compile_images(assets.images, compiled);

    BuildStatistics build;
    const Shapes shapes{.triangles = corners, .spheres = spheres};
    compiled.hierarchy = options.accelerator == Accelerator::kdtree ? build_kd_tree(shapes, options.kd, &build)
                                                                    : build_bvh(shapes, &build);
    if (statistics != nullptr) *statistics = build;
    return compiled;
}

}  // namespace raywalk
