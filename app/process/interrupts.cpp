#include "app/process/interrupts.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace raywalk {

namespace {

// Signal handlers can reach nothing but what is global.
std::atomic<bool> flag = false;
std::atomic<bool> is_graceful = false;

void handle(int) {
    if (is_graceful && !flag) {
        flag = true;
        return;
    }
    constexpr std::string_view message = "\nraywalk: interrupted\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message.data(), message.size());
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

const std::atomic<bool>& interrupted() { return flag; }

}  // namespace raywalk
