// scene_generator WHAT FILE: writes one of the meshes, textures and scenes that ship but are too large to keep.
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scenes/generate/ball_field.h"
#include "scenes/generate/sculpture.h"
#include "scenes/generate/teapot.h"
#include "scenes/generate/textures.h"
#include "tracer/files/image/image.h"
#include "tracer/ground/whole_file.h"

namespace {

using namespace generate;

// A mesh that is not what it is meant to be is worse than none.
void write_mesh(const std::filesystem::path& file, const Mesh& mesh, std::string_view about, std::size_t openings) {
    const Edges edges = count_edges(mesh);
    if (edges.crowded != 0 || edges.boundary_loops != openings)
        throw std::logic_error(file.filename().string() + " has " + std::to_string(edges.crowded) +
                               " crowded edges and " + std::to_string(edges.boundary_loops) + " openings instead of " +
                               std::to_string(openings));
    raywalk::write_whole(file, obj_text(mesh, about));
}

void generate_file(std::string_view what, const std::filesystem::path& file) {
    if (what == "teapot")
        // Open where handle and spout meet the body, at the spout's mouth, and between lid and rim.
        return write_mesh(file, teapot(16), "Martin Newell's teapot, tessellated from its Bezier patches", 6);
    if (what == "sculpture")
        return write_mesh(file, saddle_ring(1), "A ring of seven saddles with three quarter turns", 0);
    if (what == "knot") return write_mesh(file, trefoil_knot(90, 10), "A trefoil knot, coarse and without normals", 0);
    if (what == "ball_field") return raywalk::write_whole(file, ball_field_scene(10'000));
    constexpr int side = 1024;
    raywalk::write_image(file, side, side, texture(what, side).rgb);
}

}  // namespace

int main(int count, char** words) try {
    if (count != 3) throw std::invalid_argument("usage: scene_generator WHAT FILE");
    generate_file(words[1], words[2]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "scene_generator: %s\n", error.what());
    return 1;
}
