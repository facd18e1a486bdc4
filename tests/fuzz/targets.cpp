#include "tests/fuzz/targets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <iostream>

#include "tracer/files/mesh/obj_reader.h"
#include "tracer/files/scene_text/parser.h"

namespace raywalk::fuzz {

namespace {

void require(bool promise, const char* what) {
    if (promise) return;
    std::cerr << "broken promise: " << what << "\n";
    std::abort();
}

bool ordinary(const glm::dvec3& v) {
    return std::abs(v.x) <= largest_length && std::abs(v.y) <= largest_length && std::abs(v.z) <= largest_length;
}

void check_diagnostics(const std::vector<Diagnostic>& diagnostics, std::string_view input, const Limits& limits) {
    const auto ends_line = [](char c) { return c == '\n' || c == '\r'; };
    const auto lines = static_cast<std::size_t>(std::ranges::count_if(input, ends_line)) + 1;
    require(diagnostics.size() <= limits.errors + 1, "no more errors than wanted");
    for (const Diagnostic& d : diagnostics) {
        require(!d.what.empty(), "an error says what is wrong");
        require(d.where.line <= lines, "an error is in the file");
        const std::string text = to_string(d);
        require(text.size() < 1500, "an error is short");
        require(printable(text).size() == text.size() && text.find('\x1b') == std::string::npos, "an error is text");
    }
}

}  // namespace

void scene(std::string_view input) {
    const Limits limits;
    std::vector<Diagnostic> warnings;
    try {
        const Scene scene = parse_scene(input, "x.scene", limits, warnings);
        const Viewer& v = scene.viewer;
        require(v.width >= 1 && v.width <= largest_picture && v.height >= 1 && v.height <= largest_picture, "geo");
        require(ordinary(v.center) && ordinary(v.target) && v.center != v.target, "a view direction");
        require(v.fovy_degrees > 0 && v.fovy_degrees < 180, "fovy");
        for (const Plane& p : scene.planes) require(std::abs(glm::length(p.normal) - 1) < 1e-12, "unit normals");
        for (const Sphere& s : scene.spheres) require(s.radius > 0 && ordinary(s.center), "a sphere");
        std::uint64_t points = 0;
        for (const Light& l : scene.lights) points += l.area ? static_cast<std::uint64_t>(l.area->n) * l.area->n : 1;
        require(points <= limits.light_points, "the budget of lights");
        require(static_cast<std::uint64_t>(scene.viewer.width) * static_cast<std::uint64_t>(scene.viewer.height) <=
                    limits.pixels,
                "the budget of pixels");
    } catch (const InputError& error) {
        check_diagnostics(error.diagnostics(), input, limits);
    }
}

void obj(std::string_view input) {
    Limits limits;
    limits.triangles = 100'000;
    std::vector<Diagnostic> warnings;
    try {
        const TriangleMesh mesh = parse_obj(input, "x.obj", limits, warnings);
        require(!mesh.faces.empty() && mesh.faces.size() <= limits.triangles, "the budget of triangles");
        require(mesh.normal_faces.empty() || mesh.normal_faces.size() == mesh.faces.size(), "a normal for each corner");
        for (const auto& face : mesh.faces)
            for (const std::uint32_t corner : face) require(corner < mesh.positions.size(), "corners in range");
        for (const auto& face : mesh.normal_faces)
            for (const std::int32_t corner : face)
                require(corner < static_cast<std::int32_t>(mesh.normals.size()) && corner >= -1, "normals in range");
        std::vector<bool> named(mesh.positions.size());
        for (const auto& face : mesh.faces)
            for (const std::uint32_t corner : face) named[corner] = true;
        require(std::ranges::count(named, false) == 0, "each vertex in a face");
        for (const glm::vec3& p : mesh.positions)
            require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "finite vertices");
    } catch (const InputError& error) {
        check_diagnostics(error.diagnostics(), input, limits);
    }
    check_diagnostics(warnings, input, limits);
}

}  // namespace raywalk::fuzz
