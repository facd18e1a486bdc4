#include "tests/bench/first_picture.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

extern char** environ;

namespace raywalk::bench {

namespace {

// A child process whose stderr is read here.
struct Child {
    pid_t process = 0;
    int messages = -1;
};

Child start(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    Child child{.process = 0, .messages = ends[0]};
    const int error = posix_spawn(&child.process, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) throw std::runtime_error("cannot start " + arguments[0]);
    return child;
}

// Reads until the child has said that all tiles are traced; false when it never does.
bool wait_until_traced(const Child& child) {
    std::string said;
    std::array<char, 4096> buffer;
    for (ssize_t n; (n = read(child.messages, buffer.data(), buffer.size())) > 0;) {
        said.append(buffer.data(), static_cast<std::size_t>(n));
        if (said.find("100 %") != std::string::npos) return true;
    }
    return false;
}

double cpu_seconds_of(pid_t process) {
    clockid_t clock{};
    timespec time{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void finish(const Child& child) {
    std::array<char, 4096> buffer;
    while (read(child.messages, buffer.data(), buffer.size()) > 0) {
    }
    close(child.messages);
    waitpid(child.process, nullptr, 0);
}

}  // namespace

FirstPictureRow measure_first_picture(const std::filesystem::path& program, const std::filesystem::path& scene,
                                      int rounds, const std::filesystem::path& folder) {
    const std::filesystem::path picture = folder / "first.pfm", statistics = folder / "first.json";
    FirstPictureRow row;
    row.name = scene.stem().string();
    std::vector<double> wall, cpu, parse, build;
    for (int round = 0; round <= rounds; ++round) {
        const double begin = seconds(Clock::wall);
        const Child child = start({program, scene, "-render", picture, "--size", "1280x720", "--spp", "1", "--threads",
                                   "1", "--stats", statistics});
        const bool traced = wait_until_traced(child);
        const double used = cpu_seconds_of(child.process), passed = seconds(Clock::wall) - begin;
        finish(child);
        if (!traced) throw std::runtime_error(program.string() + " made no picture of " + scene.string());
        if (round == 0) continue;  // files are in memory from now on
        const nlohmann::json parts = nlohmann::json::parse(std::ifstream(statistics)).at("seconds");
        wall.push_back(passed);
        cpu.push_back(used);
        parse.push_back(parts.at("read_scene").get<double>() + parts.at("read_meshes").get<double>());
        build.push_back(parts.at("build").get<double>());
    }
    std::filesystem::remove(picture);
    std::filesystem::remove(statistics);
    row.wall = spread_of(wall);
    row.cpu = spread_of(cpu);
    row.parse = spread_of(parse).median;
    row.build = spread_of(build).median;
    return row;
}

}  // namespace raywalk::bench
