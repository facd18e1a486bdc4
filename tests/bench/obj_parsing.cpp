#include "tests/bench/obj_parsing.h"

#include <omp.h>
#include <tiny_obj_loader.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <stdexcept>

#include "tests/bench/geometry.h"

namespace raywalk::bench {

namespace {

std::size_t read_with_raywalk(const std::filesystem::path& file, int threads) {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    std::vector<Diagnostic> warnings;
    const TriangleMesh mesh = read_obj(file, Limits{}, warnings);
    omp_set_num_threads(before);
    return mesh.faces.size();
}

std::size_t read_with_tinyobj(const std::filesystem::path& file) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, file.c_str(), nullptr, true))
        throw std::runtime_error("tinyobjloader: " + error);
    std::size_t triangles = 0;
    for (const tinyobj::shape_t& shape : shapes) triangles += shape.mesh.num_face_vertices.size();
    return triangles;
}

std::size_t read_with_assimp(const std::filesystem::path& file) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.c_str(), aiProcess_Triangulate);
    if (scene == nullptr) throw std::runtime_error(std::string("assimp: ") + importer.GetErrorString());
    std::size_t triangles = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
    return triangles;
}

}  // namespace

bool ParseTable::good() const {
    for (const ParseRow& row : rows)
        if (row.triangles != rows.front().triangles) return false;
    return true;
}

ParseTable measure_parsing(double megabytes, int rounds, const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "parse.obj";
    write_obj(bumpy_sphere(static_cast<std::size_t>(megabytes * 1e6 / 38)), file);
    ParseTable table;
    table.megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
    const int threads = omp_get_max_threads();
    table.rows = {{"Raywalk, " + std::to_string(threads) + " threads", {}, {}, 0},
                  {"Raywalk, 1 thread", {}, {}, 0},
                  {"tinyobjloader", {}, {}, 0},
                  {"assimp", {}, {}, 0}};
    std::vector<std::vector<double>> cpu(table.rows.size());
    const auto reading = [&](std::size_t row, auto read) {
        return timed(Clock::wall, [&, row, read] {
            cpu[row].push_back(timed(Clock::process_cpu, [&] { table.rows[row].triangles = read(); })());
        });
    };
    const Pass passes[] = {reading(0, [&] { return read_with_raywalk(file, threads); }),
                           reading(1, [&] { return read_with_raywalk(file, 1); }),
                           reading(2, [&] { return read_with_tinyobj(file); })};
    const auto times = take_turns(passes, rounds);
    for (std::size_t i = 0; i < times.size(); ++i) table.rows[i].seconds = spread_of(times[i]);
    table.against_tinyobj = ratio_of(times[2], times[0]);
    table.one_thread_against_tinyobj = ratio_of(times[2], times[1]);
    // Once is enough for the slowest.
    const double assimp = reading(3, [&] { return read_with_assimp(file); })();
    table.rows[3].seconds = {assimp, assimp, assimp};
    for (std::size_t i = 0; i < cpu.size(); ++i) table.rows[i].cpu_seconds = spread_of(cpu[i]);
    std::filesystem::remove(file);
    return table;
}

}  // namespace raywalk::bench
