// raywalk_bench: Raywalk against Embree, tinyobjloader and assimp in one process, in turns.
#include <omp.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/report.h"

namespace raywalk::bench {
namespace {

struct Options {
    bool quick = false;
    std::optional<std::filesystem::path> json;
    std::vector<std::filesystem::path> meshes;
    std::optional<std::string> only;  // one part of the run
    std::optional<std::string> profile, scene;
};

constexpr const char* usage = R"(usage: raywalk_bench [--quick] [--json FILE] [--mesh FILE]... [--only PART]

Measures Raywalk against Embree, tinyobjloader and assimp and prints Markdown.
  --quick      fewer scenes, rounds and sizes
  --json FILE  writes everything measured as JSON
  --mesh FILE  traces this OBJ mesh too (may be repeated)
  --only PART  rays
  --scene TEXT only scenes whose name holds this text
  --profile N  traces rays of kind N (0 to 4, in the order of the table) for two seconds through each hierarchy
)";

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        const auto value = [&] {
            if (i + 1 >= arguments.size()) throw std::invalid_argument(word + " needs a value");
            return arguments[++i];
        };
        if (word == "--quick")
            options.quick = true;
        else if (word == "--json")
            options.json = value();
        else if (word == "--mesh")
            options.meshes.emplace_back(value());
        else if (word == "--only")
            options.only = value();
        else if (word == "--scene")
            options.scene = value();
        else if (word == "--profile")
            options.profile = value();
        else
            throw std::invalid_argument("unknown option '" + word + "'");
    }
    return options;
}

std::vector<Geometry> ray_workloads(const Options& options) {
    std::vector<Geometry> workloads;
    workloads.push_back(placed(bumpy_sphere(100'000), "bumpy sphere"));
    for (const auto& file : options.meshes) workloads.push_back(read_mesh(file));
    Geometry balls;
    balls.name = "10,000 spheres";
    balls.spheres = ball_field();
    Geometry both = workloads.back();
    both.name += " + 10,000 spheres";
    both.spheres = balls.spheres;
    workloads.push_back(std::move(balls));
    workloads.push_back(std::move(both));
    if (options.scene)
        std::erase_if(workloads, [&](const Geometry& g) { return g.name.find(*options.scene) == std::string::npos; });
    return workloads;
}

int run(const Options& options) {
    nlohmann::json json;
    RateOptions rate_options;
    rate_options.kernels = select_kernels();
    rate_options.rounds = options.quick ? 5 : 9;
    if (options.profile) {
        for (const Geometry& geometry : ray_workloads(options))
            for (const Accelerator accelerator : accelerators)
                std::printf(
                    "%s, %s: %.2f million rays a second\n", geometry.name.c_str(),
                    std::string(name_of(accelerator)).c_str(),
                    1e-6 * trace_for(2, ray_kinds[std::stoul(*options.profile)], accelerator, geometry, rate_options));
        return 0;
    }
    std::vector<RateRow> rates;
    for (const Geometry& geometry : ray_workloads(options)) {
        std::fprintf(stderr, "rays: %s\n", geometry.name.c_str());
        const auto rows = measure_rates(geometry, rate_options);
        rates.insert(rates.end(), rows.begin(), rows.end());
    }
    std::cout << goals_table(goals_of(rates)) << "\n" << rates_table(rates);
    json["rays"] = to_json(rates);
    if (options.json) std::ofstream(*options.json) << json.dump(2) << "\n";
    bool good = true;
    for (const RateRow& row : rates) {
        for (std::size_t a = 0; a < 2; ++a) {
            if (row.agreement[a].good()) continue;
            good = false;
            std::fprintf(stderr, "DISAGREEMENT: %s, %s, %s: %zu of %zu rays\n", row.workload.c_str(),
                         std::string(traits_of(row.kind).name).c_str(), std::string(name_of(accelerators[a])).c_str(),
                         row.agreement[a].different, row.agreement[a].rays);
        }
    }
    return good ? 0 : 1;
}

}  // namespace
}  // namespace raywalk::bench

int main(int argc, char** argv) {
    using namespace raywalk::bench;
    try {
        return run(parse({argv + 1, argv + argc}));
    } catch (const std::invalid_argument& error) {
        std::fprintf(stderr, "%s\n%s", error.what(), usage);
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "raywalk_bench: %s\n", error.what());
        return 1;
    }
}
