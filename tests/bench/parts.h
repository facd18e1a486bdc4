// The parts of a run: each measures, and tells what it found as Markdown, JSON, goals and pictures.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/plot.h"
#include "tests/bench/report.h"
#include "tracer/kernels/kernels.h"

namespace raywalk::bench {

struct Setting {
    bool quick = false;
    std::vector<std::filesystem::path> meshes;  // asked for, beside our own
    std::filesystem::path root;                 // of the project: scenes/ and objs/
    std::filesystem::path program;              // raywalk itself
    std::filesystem::path scratch;              // a folder to write in
    std::string only_scene;                     // part of a name; empty: all
    const Kernels* kernels = nullptr;
};

struct Findings {
    std::string markdown;
    nlohmann::json json;
    std::vector<Goal> goals;
    std::vector<std::string> problems;  // wrong answers, which fail the run
    std::vector<Panel> panels;
};

struct Part {
    const char* name;
    const char* title;
    Findings (*measure)(const Setting& setting);
};
const std::vector<Part>& all_parts();

std::vector<Geometry> workloads(const Setting& setting);

}  // namespace raywalk::bench
