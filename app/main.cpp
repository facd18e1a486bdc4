// raywalk: walk through a ray-traced scene, or render it.
#include <fcntl.h>
#include <malloc.h>
#include <omp.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <system_error>

#include "app/commands.h"
#include "app/process/console.h"
#include "app/process/interrupts.h"
#include "app/process/output_files.h"
#include "app/process/stacks.h"
#include "app/shipped_scenes.h"

namespace raywalk {

namespace {

constexpr std::string_view out_of_memory =
    "out of memory: a smaller --size, fewer triangles or smaller images need less";

// A file opened while a standard stream is closed would take its number, and messages would end up in it.
void keep_standard_streams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(descriptor, F_GETFD) < 0) [[maybe_unused]]
            const int opened = open("/dev/null", O_RDONLY);  // reads nothing, refuses writes
}

// Errors that leave a thread of OpenMP cannot be caught outside it; the reason is told all the same.
[[noreturn]] void end_by_terminate() {
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
        print_error("internal error");
    } catch (const std::bad_alloc&) {
        print_error(out_of_memory);
    } catch (const std::exception& error) {
        print_error(error.what());
    } catch (...) {
        print_error("internal error");
    }
    _exit(exit_failed);
}

// For what counts only when a program is loaded; if that fails it goes on as it is. The name that ps shows becomes
// "exe", and main says it again.
void start_again(char** arguments) { execv("/proc/self/exe", arguments); }

// OpenMP's threads spin after every parallel region unless told otherwise, and so take the cores from the threads that
// show the picture (20 % more processor time with a software Vulkan driver).
void wait_without_spinning(char** arguments) {
    if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
    setenv("OMP_WAIT_POLICY", "passive", 1);
    start_again(arguments);
}

int run(Options options, char** arguments) {
    options.scene = scene_file(options.scene);
    if (options.mode == Mode::travel) wait_without_spinning(arguments);
    omp_set_num_threads(options.threads);
    require_writable_outputs(options);
    if (options.mode == Mode::check) return check_command(options);
    LoadedScene loaded = load_scene(options);
    switch (options.mode) {
        case Mode::render:
            return render_command(options, loaded);
        case Mode::capture:
            return capture_command(options, std::move(loaded));
        default:
            return walk_command(options, std::move(loaded));
    }
}

int run(const std::vector<std::string>& words, char** arguments) {
    std::variant<Options, Answer> parsed;
    try {
        parsed = parse_command_line(words);
    } catch (const InputError& error) {  // of --keys
        print_diagnostics(error.diagnostics());
        return exit_usage;
    }
    if (const auto* answer = std::get_if<Answer>(&parsed)) {
        print_result(answer->text);
        return exit_done;
    }
    return run(std::get<Options>(std::move(parsed)), arguments);
}

}  // namespace

}  // namespace raywalk

int main(int count, char** arguments) {
    using namespace raywalk;
    prctl(PR_SET_NAME, "raywalk");
    mallopt(M_MMAP_THRESHOLD, 16 << 20);  // fixed: what is larger goes back to the system when it is freed
    keep_standard_streams();
    catch_interrupts();
    std::set_terminate(end_by_terminate);
    try {
        if (make_room_for_stacks()) start_again(arguments);
        return run(std::vector<std::string>(arguments + std::min(count, 1), arguments + count), arguments);
    } catch (const UsageError& error) {
        print_error(std::string(error.what()) + "\nraywalk --help lists every option");
        return exit_usage;
    } catch (const InputError& error) {
        print_diagnostics(error.diagnostics());
        return exit_input;
    } catch (const std::bad_alloc&) {
        print_error(out_of_memory);
    } catch (const std::system_error& error) {
        const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
        print_error(std::string(no_thread ? "cannot start a thread, ask for fewer with --threads: " : "") +
                    error.what());
    } catch (const std::exception& error) {
        print_error(error.what());
    }
    return exit_failed;
}
