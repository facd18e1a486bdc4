// A scene as the kernels read it: single precision, structure of arrays or gather-friendly records, immutable.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "tracer/compiled/hierarchy.h"
#include "tracer/ground/aligned.h"

namespace raywalk {

// Shape ids are one range: triangles [0, triangle_count), spheres from there, planes after the spheres; -1 is a miss.

enum class Pattern : std::int32_t { pure = 0, grid = 1, image = 2 };

// How a shape looks; shared by all shapes of the same texture line. 16 words, so that gathers scale by 64 bytes.
struct alignas(64) SurfaceRecord {
    float ambient, specular, reflection, transmission;
    std::int32_t shininess;
    Pattern pattern;
    float color[3];        // pure
    float scale;           // grid: density; image: 1 / size
    std::int32_t image;    // image: index into images, else 0
    float triangle_error;  // of hits on triangles with this surface: see triangle_offset in numeric.h
    std::int32_t padding[4];
};

// One triangle's geometric unit normal (any side) and its surface.
struct alignas(16) TriangleRecord {
    float normal[3];
    std::int32_t surface;
};

// Unit vertex normals of a smooth triangle: corner i, axis a at [3 i + a].
struct VertexNormals {
    float n[9];
};

struct alignas(32) SphereRecord {
    float center[3];
    float radius;
    float refraction_index;  // inside
    std::int32_t surface;
    std::int32_t padding[2];
};

// { p : p . normal = offset }; u = p . u_axis + shift[0], v = p . v_axis + shift[1] (spec 4.6).
struct alignas(64) PlaneRecord {
    float normal[3];
    float offset;
    float u_axis[3];
    std::int32_t surface;
    float v_axis[3];
    float shift[2];  // of the scene's zero from the local origin, less whole periods of the texture
    std::int32_t padding[3];
};

// Points of light: position and intensity * colour (already divided by n * n for an area light).
struct LightPoint {
    float position[3];
    float radiance[3];
};
struct LightGroup {
    std::uint32_t first = 0, count = 0;  // points [first, first + count): one light of the scene
};

struct ImageRecord {
    std::uint32_t first_texel = 0;  // into texels
    std::int32_t width = 1, height = 1;
};

struct CompiledScene {
    glm::dvec3 origin{0};  // the scene's coordinates of the zero of all that follows: see local_origin.h
    std::int32_t triangle_count = 0, sphere_count = 0, plane_count = 0;
    std::int32_t smooth_count = 0;  // triangles [0, smooth_count) have vertex_normals

    Hierarchy hierarchy;

    AlignedVector<TriangleRecord> triangles;
    AlignedVector<VertexNormals> vertex_normals;
    AlignedVector<TriangleCorners> smooth_corners;  // of the same triangles
    AlignedVector<SphereRecord> spheres;
    AlignedVector<PlaneRecord> planes;
    AlignedVector<SurfaceRecord> surfaces;
    AlignedVector<ImageRecord> images;    // never empty
    AlignedVector<std::uint32_t> texels;  // 0x00BBGGRR, rows from the top, all images; never empty
    std::vector<LightPoint> light_points;
    std::vector<LightGroup> light_groups;
};

}  // namespace raywalk
