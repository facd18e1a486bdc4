#include "tests/bench/whitted_on_embree.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "tests/bench/embree_scene.h"
#include "tracer/ground/numeric.h"

namespace raywalk::bench {

namespace {

constexpr float farthest = std::numeric_limits<float>::infinity();
constexpr float attenuation = 0.02f;
constexpr int last_depth = 5;
constexpr int packet = 16;

struct PathRay {
    glm::vec3 origin, direction;  // unit direction
    float length, weight, medium;
    int pixel;  // of the tile
};

struct Hit {
    float t, u, v;
    std::int32_t id;
};

// What a hit is made of before light falls on it.
struct Surface {
    glm::vec3 position, geometric_normal, normal, view, color;
    const SurfaceRecord* material;
    float length, weight, offset, refraction_index;
    bool sphere;
    glm::vec3 lift{0};  // from a smooth triangle to where its shadow rays end
    glm::vec3 local{0};
};

glm::vec3 vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// One tile after the other; the vectors are reused.
class TileRenderer {
  public:
    TileRenderer(const CompiledScene& scene, RTCScene embree, const View& view)
        : scene_(scene), embree_(embree), view_(view) {}

    void render(int x, int y, FloatImage& image) {
        make_camera_rays(x, y);
        glm::vec3 radiance[tile_pixels] = {};
        for (int depth = 0; depth <= last_depth && !rays_.empty(); ++depth) {
            intersect(depth == 0);
            next_.clear();
            surfaces_.clear();
            pixels_.clear();
            for (std::size_t i = 0; i < rays_.size(); ++i)
                if (hits_[i].id >= 0) add_surface(rays_[i], hits_[i], depth);
            light_surfaces(depth == 0);
            for (std::size_t i = 0; i < surfaces_.size(); ++i)
                radiance[pixels_[i]] +=
                    surfaces_[i].weight * (0.2f * surfaces_[i].material->ambient + surfaces_[i].local);
            std::swap(rays_, next_);
        }
        for (int lane = 0; lane < tile_pixels; ++lane) {
            const int px = x + tile_pixel_x(lane), py = y + tile_pixel_y(lane);
            if (px >= view_.width || py >= view_.height) continue;
            float* rgb = &image.rgb[(static_cast<std::size_t>(py) * static_cast<std::size_t>(view_.width) +
                                     static_cast<std::size_t>(px)) *
                                    3];
            for (int c = 0; c < 3; ++c) rgb[c] = radiance[lane][c];
        }
    }

  private:
    void make_camera_rays(int x, int y) {
        const Camera& camera = view_.camera;
        const bool flat = camera.projection == Projection::orthographic;
        const double half_height = flat ? camera.orthographic_half.y : camera.half_height;
        const double half_width = flat ? camera.orthographic_half.x : half_height * view_.width / view_.height;
        const glm::vec3 right(camera.right * (2 * half_width / view_.width)),
            down(camera.up * (-2 * half_height / view_.height));
        const glm::vec3 corner(camera.direction + camera.right * (2 * half_width * x / view_.width - half_width) +
                               camera.up * (half_height - 2 * half_height * y / view_.height));
        const glm::vec3 eye(camera.eye), direction(camera.direction);
        rays_.clear();
        for (int lane = 0; lane < tile_pixels; ++lane) {
            const glm::vec3 point = corner + right * (static_cast<float>(tile_pixel_x(lane)) + 0.5f) +
                                    down * (static_cast<float>(tile_pixel_y(lane)) + 0.5f);
            rays_.push_back({flat ? eye + point : eye, flat ? direction : glm::normalize(point), 0, 1, 1, lane});
        }
    }

    // Planes first: Embree then looks no farther.
    Hit nearest_plane(const PathRay& ray) const {
        Hit hit{farthest, 0, 0, -1};
        for (std::int32_t i = 0; i < scene_.plane_count; ++i) {
            const PlaneRecord& plane = scene_.planes[static_cast<std::size_t>(i)];
            const glm::vec3 normal = vec(plane.normal);
            const float t = (plane.offset - glm::dot(normal, ray.origin)) / glm::dot(normal, ray.direction);
            if (t > 0 && t < hit.t) hit = {t, 0, 0, scene_.triangle_count + scene_.sphere_count + i};
        }
        return hit;
    }

    void intersect(bool coherent) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        hits_.resize(rays_.size());
        alignas(64) RTCRayHit16 rays;
        alignas(64) int valid[packet];
        for (std::size_t first = 0; first < rays_.size(); first += packet) {
            const std::size_t count = std::min<std::size_t>(packet, rays_.size() - first);
            for (std::size_t i = 0; i < packet; ++i) {
                valid[i] = i < count ? -1 : 0;
                const PathRay& ray = rays_[first + std::min(i, count - 1)];
                Hit& hit = hits_[first + std::min(i, count - 1)];
                hit = nearest_plane(ray);
                rays.ray.org_x[i] = ray.origin.x, rays.ray.org_y[i] = ray.origin.y, rays.ray.org_z[i] = ray.origin.z;
                rays.ray.dir_x[i] = ray.direction.x, rays.ray.dir_y[i] = ray.direction.y;
                rays.ray.dir_z[i] = ray.direction.z;
                rays.ray.tnear[i] = 0, rays.ray.tfar[i] = hit.t;
                rays.ray.time[i] = 0, rays.ray.mask[i] = ~0u, rays.ray.flags[i] = 0;
                rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            }
            rtcIntersect16(valid, embree_, &context, &rays);
            for (std::size_t i = 0; i < count; ++i) {
                if (rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
                hits_[first + i] = {rays.ray.tfar[i], rays.hit.u[i], rays.hit.v[i],
                                    static_cast<std::int32_t>(rays.hit.primID[i]) +
                                        (rays.hit.geomID[i] == 0 ? 0 : scene_.triangle_count)};
            }
        }
    }

    void add_surface(const PathRay& ray, const Hit& hit, int depth) {
        Surface s{};
        s.position = ray.origin + hit.t * ray.direction;
        s.refraction_index = 1;
        float error = 0;  // of the position, where it was computed from larger numbers
        std::int32_t surface = 0;
        const PlaneRecord* plane = nullptr;
        bool smooth = false;
        if (hit.id < scene_.triangle_count) {
            const TriangleRecord& triangle = scene_.triangles[static_cast<std::size_t>(hit.id)];
            s.geometric_normal = vec(triangle.normal);
            surface = triangle.surface;
            error = scene_.surfaces[static_cast<std::size_t>(surface)].triangle_error;
            smooth = hit.id < scene_.smooth_count;
        } else if (hit.id < scene_.triangle_count + scene_.sphere_count) {
            const SphereRecord& sphere = scene_.spheres[static_cast<std::size_t>(hit.id - scene_.triangle_count)];
            s.sphere = true;
            s.geometric_normal = glm::normalize(s.position - vec(sphere.center));
            s.position = vec(sphere.center) + sphere.radius * s.geometric_normal;
            s.refraction_index = sphere.refraction_index;
            const glm::vec3 center = glm::abs(vec(sphere.center));
            error = sphere_offset * (std::max(center.x, std::max(center.y, center.z)) + sphere.radius);
            surface = sphere.surface;
        } else {
            plane = &scene_.planes[static_cast<std::size_t>(hit.id - scene_.triangle_count - scene_.sphere_count)];
            s.geometric_normal = vec(plane->normal);
            surface = plane->surface;
        }
        s.normal = glm::dot(s.geometric_normal, ray.direction) > 0 ? -s.geometric_normal : s.geometric_normal;
        if (smooth) {
            const float* n = scene_.vertex_normals[static_cast<std::size_t>(hit.id)].n;
            const glm::vec3 sum = (1 - hit.u - hit.v) * glm::vec3(n[0], n[1], n[2]) +
                                  hit.u * glm::vec3(n[3], n[4], n[5]) + hit.v * glm::vec3(n[6], n[7], n[8]);
            if (glm::dot(sum, sum) > 1e-12f) {
                const glm::vec3 facing = s.normal;
                const float side = glm::dot(sum, facing) < 0 ? -1.0f : 1.0f;
                s.normal = side * glm::normalize(sum);
                const TriangleCorners& corners = scene_.smooth_corners[static_cast<std::size_t>(hit.id)];
                const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
                glm::vec3 lift(0);
                for (int i = 0; i < 3; ++i) {
                    const glm::vec3 corner_normal(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
                    const float height = side * glm::dot(s.position - corners.p[i], corner_normal);
                    lift -= weights[i] * std::min(height, 0.0f) * side * corner_normal;
                }
                if (glm::dot(lift, facing) > 0) s.lift = lift;
            }
        }
        s.material = &scene_.surfaces[static_cast<std::size_t>(surface)];
        s.color = color_of(s, plane);
        s.view = -ray.direction;
        s.length = ray.length + hit.t;
        s.weight = ray.weight;
        const glm::vec3 reach = glm::abs(s.position);
        s.offset = std::max(error, surface_offset * std::max(std::max(reach.x, reach.y), std::max(reach.z, hit.t)));
        surfaces_.push_back(s);
        pixels_.push_back(ray.pixel);
        if (depth < last_depth) spawn(ray, s);
    }

    [[nodiscard]] glm::vec3 color_of(const Surface& s, const PlaneRecord* plane) const {
        const SurfaceRecord& material = *s.material;
        if (material.pattern == Pattern::pure) return vec(material.color);
        float u = 0, v = 0;
        if (plane != nullptr) {
            u = glm::dot(s.position, vec(plane->u_axis));
            v = glm::dot(s.position, vec(plane->v_axis));
        } else if (s.sphere) {
            u = std::atan2(s.normal.y, s.normal.x) / (2 * std::numbers::pi_v<float>);
            v = std::asin(s.normal.z) / (2 * std::numbers::pi_v<float>);
        }
        u *= material.scale, v *= material.scale;
        if (material.pattern == Pattern::grid) {
            const float half = (std::floor(u) + std::floor(v)) * 0.5f;
            return glm::vec3(std::floor(half) < half ? 1.0f : 0.0f);
        }
        const ImageRecord& image = scene_.images[static_cast<std::size_t>(material.image)];
        const auto cell = [](float x, std::int32_t count) {
            return std::min(static_cast<std::int32_t>((x - std::floor(x)) * static_cast<float>(count)), count - 1);
        };
        const std::int32_t at = cell(u, image.height) * image.width + cell(v, image.width);
        const std::uint32_t texel = scene_.texels[image.first_texel + static_cast<std::uint32_t>(at)];
        return glm::vec3(texel & 255, texel >> 8 & 255, texel >> 16 & 255) * (1.0f / 255.0f);
    }

    void spawn(const PathRay& ray, const Surface& s) {
        const glm::vec3 mirrored = ray.direction - 2 * glm::dot(ray.direction, s.normal) * s.normal;
        const auto add = [&](const glm::vec3& direction, float weight, float medium) {
            const float side = std::copysign(s.offset, glm::dot(direction, s.geometric_normal));
            next_.push_back({s.position + side * s.geometric_normal, direction, s.length, weight, medium, ray.pixel});
        };
        if (s.material->reflection > 0) add(mirrored, ray.weight * s.material->reflection, ray.medium);
        if (!(s.material->transmission > 0)) return;
        const float weight = ray.weight * s.material->transmission;
        if (!s.sphere) return add(ray.direction, weight, ray.medium);
        const float cosine = -glm::dot(ray.direction, s.normal);
        const float index = glm::dot(ray.direction, s.geometric_normal) < 0 ? s.refraction_index : 1.0f;
        const float eta = ray.medium / index;
        const float squared = 1 - eta * eta * (1 - cosine * cosine);
        if (squared < 0) return add(mirrored, weight, ray.medium);
        add(glm::normalize(eta * ray.direction + (eta * cosine - std::sqrt(squared)) * s.normal), weight, index);
    }

    // Shadow rays go from the light to the surfaces: of one origin, as Embree's coherent packets like them best.
    void light_surfaces(bool coherent) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        alignas(64) RTCRay16 rays;
        alignas(64) int valid[packet];
        glm::vec3 received[packet];
        for (const LightGroup& group : scene_.light_groups) {
            for (std::uint32_t p = group.first; p < group.first + group.count; ++p) {
                const LightPoint& light = scene_.light_points[p];
                for (std::size_t first = 0; first < surfaces_.size(); first += packet) {
                    const std::size_t count = std::min<std::size_t>(packet, surfaces_.size() - first);
                    int any = 0;
                    for (std::size_t i = 0; i < packet; ++i) {
                        valid[i] = 0;
                        if (i >= count) continue;
                        glm::vec3 to_surface;
                        received[i] = light_received(surfaces_[first + i], light, to_surface);
                        if (received[i] == glm::vec3(0)) continue;
                        rays.org_x[i] = light.position[0], rays.org_y[i] = light.position[1];
                        rays.org_z[i] = light.position[2];
                        rays.dir_x[i] = to_surface.x, rays.dir_y[i] = to_surface.y, rays.dir_z[i] = to_surface.z;
                        rays.tnear[i] = 0, rays.tfar[i] = shadow_t_max;
                        rays.time[i] = 0, rays.mask[i] = ~0u, rays.flags[i] = 0;
                        valid[i] = plane_between(light, to_surface) ? 0 : -1;
                        any |= valid[i];
                    }
                    if (any == 0) continue;
                    rtcOccluded16(valid, embree_, &context, &rays);
                    for (std::size_t i = 0; i < count; ++i)
                        if (valid[i] != 0 && !(rays.tfar[i] < 0)) surfaces_[first + i].local += received[i];
                }
            }
        }
    }

    // What the surface gets if it sees the light; `to_surface`: from the light to just above it.
    static glm::vec3 light_received(const Surface& s, const LightPoint& light, glm::vec3& to_surface) {
        const SurfaceRecord& material = *s.material;
        const glm::vec3 to_light = vec(light.position) - s.position;
        const float distance = glm::length(to_light);
        const glm::vec3 l = to_light / distance;
        const float cosine = glm::dot(l, s.normal);
        const float diffuse = std::max(cosine, 0.0f);
        const float mirrored = std::max(2 * cosine * glm::dot(s.normal, s.view) - glm::dot(l, s.view), 0.0f);
        float specular = 0;
        if (material.specular > 0 && mirrored > 0) {
            const float squared = mirrored * mirrored;
            specular = material.specular * (material.shininess == 5 ? squared * squared * mirrored
                                                                    : std::pow(mirrored, float(material.shininess)));
        }
        if (!(diffuse > 0 && s.color != glm::vec3(0)) && !(specular > 0)) return glm::vec3(0);
        const glm::vec3 towards = s.lift == glm::vec3(0) ? to_light : s.view;
        const float side = std::copysign(s.offset, glm::dot(s.geometric_normal, towards));
        to_surface = side * s.geometric_normal - to_light + s.lift;
        return std::exp(-attenuation * (s.length + distance)) * vec(light.radiance) * (diffuse * s.color + specular);
    }

    [[nodiscard]] bool plane_between(const LightPoint& light, const glm::vec3& direction) const {
        for (std::int32_t i = 0; i < scene_.plane_count; ++i) {
            const PlaneRecord& plane = scene_.planes[static_cast<std::size_t>(i)];
            const float t = (plane.offset - glm::dot(vec(plane.normal), vec(light.position))) /
                            glm::dot(vec(plane.normal), direction);
            if (t > 0 && t < shadow_t_max) return true;
        }
        return false;
    }

    const CompiledScene& scene_;
    RTCScene embree_;
    const View& view_;
    std::vector<PathRay> rays_, next_;
    std::vector<Hit> hits_;
    std::vector<Surface> surfaces_;
    std::vector<int> pixels_;  // of surfaces_
};

}  // namespace

FloatImage render_on_embree(const CompiledScene& scene, RTCScene embree, const View& view) {
    const FlushDenormals flush;
    FloatImage image{view.width, view.height, {}};
    image.rgb.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height) * 3);
    TileRenderer renderer(scene, embree, view);
    for (int y = 0; y < view.height; y += tile_size)
        for (int x = 0; x < view.width; x += tile_size) renderer.render(x, y, image);
    return image;
}

}  // namespace raywalk::bench
