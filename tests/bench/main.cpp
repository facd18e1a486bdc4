// raywalk_bench: Raywalk against Embree, tinyobjloader and assimp in one process, in turns.
#include <omp.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "tests/bench/parts.h"
#include "tracer/ground/whole_file.h"

namespace raywalk::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* usage = R"(usage: raywalk_bench [OPTION]...

Measures Raywalk against Embree, tinyobjloader and assimp, and prints Markdown.

  --quick        fewer scenes, rounds and sizes
  --json FILE    writes everything measured as JSON
  --plot FILE    writes the growth as an SVG picture
  --mesh FILE    measures with this OBJ mesh too; may be repeated
  --only PART    rays, builds, frames, obj, growth or first; may be repeated
  --scene TEXT   only scenes and meshes whose name holds this text
  --profile N    traces rays of kind N (0 to 4, in the order of the table) for two seconds through each hierarchy,
                 for a profiler to look at
  --isa NAME     the instruction set to use: avx512, avx2, sse4 or scalar

Exit codes: 0 done, 1 a hit or a picture of ours is wrong or the work failed, 2 wrong command line.
)";

struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Options {
    Setting setting;
    std::optional<fs::path> json, plot;
    std::vector<std::string> only;
    std::optional<std::size_t> profile;
    bool help = false;
};

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    std::optional<std::string> isa;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        const auto value = [&] {
            if (i + 1 >= arguments.size()) throw UsageError(word + " needs a value");
            return arguments[++i];
        };
        if (word == "--quick")
            options.setting.quick = true;
        else if (word == "--json")
            options.json = value();
        else if (word == "--plot")
            options.plot = value();
        else if (word == "--mesh")
            options.setting.meshes.emplace_back(fs::absolute(value()));
        else if (word == "--only")
            options.only.push_back(value());
        else if (word == "--scene")
            options.setting.only_scene = value();
        else if (word == "--isa")
            isa = value();
        else if (word == "--help" || word == "-h")
            options.help = true;
        else if (word == "--profile") {
            const std::string kind = value();
            if (kind.size() != 1 || kind[0] < '0' || kind[0] > '4')
                throw UsageError("--profile needs a number from 0 to 4");
            options.profile = static_cast<std::size_t>(kind[0] - '0');
        } else
            throw UsageError("unknown option '" + word + "'");
    }
    options.setting.kernels = isa ? select_kernels(*isa) : select_kernels();
    if (options.setting.kernels == nullptr) throw UsageError("this machine cannot run '" + *isa + "'");
    for (const std::string& name : options.only) {
        bool known = false;
        for (const Part& part : all_parts()) known |= part.name == name;
        if (!known) throw UsageError("--only: there is no part '" + name + "'");
    }
    for (const fs::path& mesh : options.setting.meshes)
        if (!fs::exists(mesh)) throw UsageError("there is no mesh '" + mesh.string() + "'");
    return options;
}

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

// A folder of its own, gone with the object.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "raywalk-bench-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder " + name);
        path = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    fs::path path;
};

int profile(const Options& options) {
    RateOptions rates;
    rates.kernels = options.setting.kernels;
    for (const Geometry& geometry : workloads(options.setting))
        for (const Accelerator accelerator : accelerators)
            std::printf("%s, %s: %.2f million rays a second\n", geometry.name.c_str(),
                        std::string(name_of(accelerator)).c_str(),
                        1e-6 * trace_for(2, ray_kinds[*options.profile], accelerator, geometry, rates));
    return 0;
}

bool chosen(const Options& options, const Part& part) {
    if (options.only.empty()) return true;
    for (const std::string& name : options.only)
        if (name == part.name) return true;
    return false;
}

int run(Options options) {
    if (options.profile) return profile(options);
    const ScratchFolder scratch;
    options.setting.scratch = scratch.path;
    options.setting.root = RAYWALK_ROOT;
    options.setting.program = fs::canonical("/proc/self/exe").parent_path() / "raywalk";

    const std::string machine = processor() + ", " + std::to_string(omp_get_max_threads()) + " threads, " +
                                std::string(options.setting.kernels->name) + ", Embree " EMBREE_VERSION;
    nlohmann::json json = {{"machine", machine}, {"quick", options.setting.quick}};
    std::vector<Goal> goals;
    std::vector<std::string> problems;
    std::vector<Panel> panels;
    std::string text;
    for (const Part& part : all_parts()) {
        if (!chosen(options, part)) continue;
        std::fprintf(stderr, "%s\n", part.title);
        Findings findings = part.measure(options.setting);
        text += "\n## " + std::string(part.title) + "\n\n" + findings.markdown;
        json[part.name] = findings.json;
        goals.insert(goals.end(), findings.goals.begin(), findings.goals.end());
        problems.insert(problems.end(), findings.problems.begin(), findings.problems.end());
        panels.insert(panels.end(), findings.panels.begin(), findings.panels.end());
    }
    json["goals"] = to_json(goals);
    json["problems"] = problems;
    std::cout << "Measured on: " << machine << ".\n\n## Goals\n\n" << goals_table(goals) << text << std::flush;
    if (options.json) write_whole(*options.json, json.dump(2) + "\n");
    if (options.plot && !panels.empty()) write_whole(*options.plot, svg_of(panels, 3));
    for (const std::string& problem : problems) std::fprintf(stderr, "WRONG: %s\n", problem.c_str());
    return problems.empty() ? 0 : 1;
}

}  // namespace
}  // namespace raywalk::bench

int main(int argc, char** argv) {
    using namespace raywalk::bench;
    // OpenMP's threads must not spin beside what is measured; libgomp reads this when it is loaded.
    if (std::getenv("OMP_WAIT_POLICY") == nullptr) {
        setenv("OMP_WAIT_POLICY", "passive", 1);
        execv("/proc/self/exe", argv);
    }
    try {
        const Options options = parse({argv + 1, argv + argc});
        if (!options.help) return run(options);
        std::fputs(usage, stdout);
        return 0;
    } catch (const UsageError& error) {
        std::fprintf(stderr, "raywalk_bench: %s\n\n%s", error.what(), usage);
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "raywalk_bench: %s\n", error.what());
        return 1;
    }
}
