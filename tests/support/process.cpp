#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace raywalk::test {

namespace {

struct Ends {
    int read = -1, write = -1;
};

Ends open_pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    return {ends[0], ends[1]};
}

Ends open_terminal(int columns) {
    Ends ends;
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = 24;
    if (openpty(&ends.read, &ends.write, nullptr, nullptr, &size) != 0) throw std::runtime_error("openpty");
    fcntl(ends.read, F_SETFD, FD_CLOEXEC);
    fcntl(ends.write, F_SETFD, FD_CLOEXEC);
    return ends;
}

// In the child: never returns.
[[noreturn]] void become(const Process& process, int output, int errors) {
    if (process.closed_output)
        close(STDOUT_FILENO);
    else if (!process.output_file.empty())
        dup2(open(process.output_file.c_str(), O_WRONLY), STDOUT_FILENO);
    else
        dup2(output, STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    for (const std::string& variable : process.environment) {
        const std::size_t equals = variable.find('=');
        if (equals == std::string::npos)
            unsetenv(variable.c_str());
        else
            setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
    const auto set_limit = [](auto resource, std::size_t most) {
        const rlimit limit{most, most};
        if (most > 0) setrlimit(resource, &limit);
    };
    set_limit(RLIMIT_AS, process.memory_limit);
    set_limit(RLIMIT_FSIZE, process.file_size_limit);
    set_limit(RLIMIT_STACK, process.stack_limit);
    if (chdir(process.folder.c_str()) != 0) _exit(126);
    std::vector<char*> words;
    for (const std::string& word : process.words) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execvp(words[0], words.data());
    _exit(127);
}

// Reads both until both are closed, or two minutes have passed.
void read_all(int output, int errors, Outcome& outcome) {
    pollfd files[2] = {{output, POLLIN, 0}, {errors, POLLIN, 0}};
    std::string* texts[2] = {&outcome.output, &outcome.errors};
    while (files[0].fd >= 0 || files[1].fd >= 0) {
        if (poll(files, 2, 120'000) <= 0) return;
        for (int i = 0; i < 2; ++i) {
            if (files[i].fd < 0 || files[i].revents == 0) continue;
            char buffer[4096];
            const ssize_t count = read(files[i].fd, buffer, sizeof buffer);
            if (count > 0)
                texts[i]->append(buffer, static_cast<std::size_t>(count));
            else
                files[i].fd = -1;  // the end; a terminal says EIO
        }
    }
}

}  // namespace

Outcome run(const Process& process) {
    const Ends output = open_pipe();
    const Ends errors = process.terminal_columns > 0 ? open_terminal(process.terminal_columns) : open_pipe();
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork");
    if (child == 0) become(process, output.write, errors.write);
    close(output.write);
    close(errors.write);
    if (process.started) process.started(child);
    Outcome outcome;
    read_all(output.read, errors.read, outcome);
    close(output.read);
    close(errors.read);
    // Both texts have ended, and so has the program unless something is wrong with it.
    int status = 0;
    pid_t ended = 0;
    for (int wait = 0; wait < 1000 && ended == 0; ++wait) {
        ended = waitpid(child, &status, WNOHANG);
        if (ended == 0) usleep(10'000);
    }
    if (ended == 0) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    return outcome;
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "raywalk-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::vector<std::filesystem::path> parts_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> parts;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".part") parts.push_back(entry.path());
    return parts;
}

}  // namespace raywalk::test
