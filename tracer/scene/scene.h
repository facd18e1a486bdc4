// A scene as its text means it: plain values in double precision, nothing derived.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "tracer/ground/error.h"

namespace raywalk {

// Phong coefficients, reflection and transmission (spec: MATERIAL). shininess is the exponent n >= 0.
struct Material {
    std::string_view name;
    double ambient, specular;
    int shininess;
    double reflection, transmission;
};

inline constexpr Material materials[] = {
    {"FLOOR", 0, 0.1, 5, 0, 0},          {"MIRROR", 0, 0.2, 5, 1.0, 0},
    {"A_BIT_MIRROR", 0, 0.2, 5, 0.3, 0}, {"TRANSPARENT_MATERIAL", 0, 0, 0, 0, 1.0},
    {"PLASTIC", 0.05, 0.2, 5, 0, 0},
};

struct PureTexture {
    glm::dvec3 color{1};
};
struct GridTexture {
    int density = 1;  // cells per unit of u and v
};
struct ImageTexture {
    std::filesystem::path file;  // resolved against the scene's folder
    int size = 4;                // side of one tile in units of u and v
    SourceLocation where = {};   // of the file name, for errors found when the image is read
};

struct Texture {
    Material material = materials[0];
    std::variant<PureTexture, GridTexture, ImageTexture> pattern;
};

struct DepthOfField {
    double aperture_radius = 0;  // scene units, >= 0
    double focal_distance = 1;   // along the view direction, > 0
    int samples = 1;
};

struct Viewer {
    int width = 0, height = 0;           // pixels, 1..16384
    std::optional<glm::dvec2> viewport;  // scene units; present: the walk starts orthographic
    glm::dvec3 center{0}, target{0, 0, -1}, up{0, 1, 0};
    double fovy_degrees = 45;
    std::optional<DepthOfField> depth_of_field;
    std::optional<int> antialiasing;
};

// `area n radius`: n x n points on a sphere around the origin (spec 4.5).
struct AreaSpread {
    int n = 1;
    double radius = 0;
};

struct Light {
    glm::dvec3 origin{0}, color{1};
    double intensity = 1;
    std::optional<AreaSpread> area;
};

struct Plane {
    Texture texture;
    glm::dvec3 normal{0, 1, 0};  // unit length
    double offset = 0;           // { p : p . normal = offset }
};

struct Sphere {
    Texture texture;
    glm::dvec3 center{0};
    double radius = 1;
    double refraction_index = 1;
};

struct Face {
    Texture texture;
    glm::dvec3 a{0}, b{0}, c{0};
};

struct Mesh {
    Texture texture;
    std::filesystem::path file;  // resolved against the scene's folder
    SourceLocation where = {};   // of the file name
    glm::dvec3 center{0};        // the vertex mean is moved here
    double radius = 1;           // and the farthest vertex scaled to this distance from it
    bool smooth = false;
};

struct Scene {
    std::filesystem::path file;
    Viewer viewer;
    std::vector<Light> lights;
    std::vector<Plane> planes;
    std::vector<Sphere> spheres;
    std::vector<Face> faces;
    std::vector<Mesh> meshes;
};

}  // namespace raywalk
