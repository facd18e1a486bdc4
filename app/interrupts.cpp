#include "app/interrupts.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>

namespace raywalk {

namespace {

// Signal handlers can reach nothing but what is global, and no more than async-signal-safe functions.
std::atomic<bool> flag = false;
std::atomic<bool> is_graceful = false;
std::atomic<bool> is_saving = false;
std::atomic<std::int64_t> first_signal = 0;  // milliseconds of the monotonic clock

// Terminals, wrappers and job systems send a signal twice; within this time it is the same wish.
constexpr std::int64_t same_wish_milliseconds = 500;

std::int64_t milliseconds_now() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1000000;
}

// Dropped where stderr takes nothing more: a full pipe that nobody reads would keep the program from ending.
void say(std::string_view message) {
    pollfd place{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    if (poll(&place, 1, 0) != 1) return;
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message.data(), message.size());
}

void handle(int) {
    const int error = errno;  // of what was interrupted
    if (is_graceful) {
        const std::int64_t now = milliseconds_now();
        if (!flag.exchange(true)) {
            first_signal = now;
            errno = error;
            return;
        }
        if (is_saving || now - first_signal < same_wish_milliseconds) {
            if (now - first_signal >= same_wish_milliseconds) say("\nraywalk: saving ...\n");
            errno = error;
            return;
        }
    }
    say("\nraywalk: interrupted\n");
    _exit(130);
}

void install(int signal) {
    struct sigaction action = {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
    struct sigaction action = {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void catch_interrupts() {
    install(SIGINT);
    install(SIGTERM);
    if (!is_ignored(SIGHUP)) install(SIGHUP);  // ignored: started by nohup
    install(SIGXCPU);                          // the end of the time that ulimit gives
    // Writes fail instead, with a message: nobody reads, or the file would be larger than ulimit allows.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

GracefulInterrupts::GracefulInterrupts() { is_graceful = true; }
GracefulInterrupts::~GracefulInterrupts() { is_graceful = false; }

UnbreakableSaving::UnbreakableSaving(bool appears_whole) { is_saving = appears_whole; }
UnbreakableSaving::~UnbreakableSaving() { is_saving = false; }

const std::atomic<bool>& interrupted() { return flag; }

}  // namespace raywalk
