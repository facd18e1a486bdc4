#include "tracer/files/helper_program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <csignal>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "tracer/ground/descriptor.h"
#include "tracer/ground/error.h"

namespace raywalk {

namespace fs = std::filesystem;

namespace {

// Threads that libraries start have stacks of this size, and main has room for more than any decoder needs.
constexpr rlim_t small_stack = 1 << 20;

// All that a helper knows of the world: one thread for whoever asks, one arena of malloc.
constexpr std::array environment = {"LC_ALL=C", "OPENIMAGEIO_THREADS=1", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1",
                                    "MALLOC_ARENA_MAX=1"};

// Where the program lies, and whose it is. The link in /proc is the kernel's word; without it there is none to trust.
struct Home {
    fs::path folder;
    uid_t owner = 0;
};
Home home_of_the_program() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    struct stat status {};
    if (error || !program.is_absolute() || stat(program.c_str(), &status) != 0)
        throw WorkError("this program cannot tell where it lies, and so not where its helpers are; is /proc mounted?");
    return {program.parent_path(), status.st_uid};
}

// What becomes the helper, between vfork and exec: system calls only, on memory that is the parent's.
struct Start {
    int program;
    char* const* arguments;
    char* const* variables;
    const int* files;
    int file_count;
    sigset_t signals;
};
[[noreturn]] void become_helper(const Start& start) {
    setpgid(0, 0);
    struct sigaction usual = {};
    usual.sa_handler = SIG_DFL;
    for (int signal = 1; signal < NSIG; ++signal) sigaction(signal, &usual, nullptr);
    // Out of the way of 0, 1, 2, ... first; the copies are closed by exec.
    constexpr int most_files = 4;
    int moved[most_files];
    for (int i = 0; i < start.file_count; ++i) moved[i] = fcntl(start.files[i], F_DUPFD_CLOEXEC, 16);
    const int program = fcntl(start.program, F_DUPFD_CLOEXEC, 16), silence = open("/dev/null", O_WRONLY | O_CLOEXEC);
    bool ready = program >= 0 && silence >= 0 && dup2(silence, 2) == 2;
    for (int i = 0; i < start.file_count; ++i) ready = ready && dup2(moved[i], i < 2 ? i : i + 1) >= 0;
    const unsigned last = start.file_count < 3 ? 2 : static_cast<unsigned>(start.file_count);
    syscall(SYS_close_range, last + 1, ~0U, 1U << 2);  // CLOSE_RANGE_CLOEXEC; older kernels: ours close by themselves
    const rlimit stack{small_stack, small_stack};
    setrlimit(RLIMIT_STACK, &stack);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    sigprocmask(SIG_SETMASK, &start.signals, nullptr);
    if (ready) syscall(SYS_execveat, program, "", start.arguments, start.variables, AT_EMPTY_PATH);
    _exit(127);
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

// Waits until the process has ended; false when `seconds` are over first.
bool wait_for(pid_t pid, double seconds) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(seconds == 0 ? 1e9 : seconds));
    const Descriptor process(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
    for (;;) {
        siginfo_t info{};
        const int result = waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
        if (info.si_pid == pid || (result != 0 && errno != EINTR)) return true;
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        if (left <= 0) return false;
        pollfd one{process.get(), POLLIN, 0};
        if (process.get() >= 0)
            poll(&one, 1, static_cast<int>(std::min<long long>(left + 1, 60'000)));
        else  // a kernel older than 5.3
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

}  // namespace

std::string distrust(uid_t file_owner, gid_t file_group, mode_t mode, uid_t owner) {
    if (file_owner != 0 && file_owner != owner) return "belongs to neither root nor the owner of this program";
    if ((mode & S_IWOTH) != 0) return "may be changed by everybody";
    // Many a user has a group of their own, which files of theirs are open to.
    const bool own_group = file_group == getegid() && file_owner == geteuid();
    if ((mode & S_IWGRP) != 0 && file_group != 0 && !own_group) return "may be changed by its group";
    return {};
}

int open_helper(const std::string& name) {
    const Home home = home_of_the_program();
    for (const fs::path& folder : {home.folder, home.folder / "../lib/raywalk"}) {
        const Descriptor inside(open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
        if (inside.get() < 0) continue;
        Descriptor program(openat(inside.get(), name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
        if (program.get() < 0) continue;
        for (const int fd : {inside.get(), program.get()}) {
            struct stat status {};
            if (fstat(fd, &status) != 0) fail_with("'" + (folder / name).string() + "' cannot be run", errno);
            if (const std::string reason = distrust(status.st_uid, status.st_gid, status.st_mode, home.owner);
                !reason.empty())
                throw WorkError("'" + (fd == program.get() ? folder / name : folder).string() +
                                "' is not run or searched, as it " + reason);
        }
        return program.release();
    }
    throw WorkError("the program " + name + " is neither in " + home.folder.string() +
                    " nor in ../lib/raywalk from there");
}

RunningHelper::RunningHelper(const std::string& name, std::vector<std::string> arguments, std::span<const int> files) {
    const Descriptor program(open_helper(name));
    arguments.insert(arguments.begin(), name);
    std::vector<std::string> variables(environment.begin(), environment.end());
    const std::vector<char*> words = pointers_to(arguments), settings = pointers_to(variables);
    Start start{program.get(), words.data(), settings.data(), files.data(), static_cast<int>(files.size()), {}};
    sigemptyset(&start.signals);
    // No handler of this program may run in the child, whose memory is the parent's until it has become the helper.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const pid_t pid = vfork();
    if (pid == 0) become_helper(start);
    const int error = errno;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (pid < 0) fail_with("the program " + name + " cannot be run", error);
    pid_ = pid;
}

RunningHelper::~RunningHelper() {
    if (pid_ == 0) return;
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
}

std::string RunningHelper::end(double seconds) {
    const bool in_time = wait_for(pid_, seconds);
    if (!in_time) kill(pid_, SIGKILL);
    const pid_t pid = std::exchange(pid_, 0);
    int status = 0;
    while (waitpid(pid, &status, 0) < 0) {
        if (errno == EINTR) continue;
        return {};  // nobody keeps its status for us; its reply says enough
    }
    if (!in_time) return "it takes too much time";
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        return "it takes too much time or memory";
    if (WIFSIGNALED(status)) return std::string("its codec broke (") + strsignal(WTERMSIG(status)) + ")";
    if (WEXITSTATUS(status) == 127) throw WorkError("a codec of images cannot start; are its libraries installed?");
    return WEXITSTATUS(status) == 0 ? "" : "its codec gave up";
}

}  // namespace raywalk
