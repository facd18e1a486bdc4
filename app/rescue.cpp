#include "app/rescue.h"

#include <omp.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <system_error>
#include <utility>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupts.h"

namespace raywalk {

namespace {

using namespace std::chrono_literals;

constexpr auto look_interval = 25ms, rescue_patience = 250ms;

// Whether the work goes on after that time; false as soon as it returns.
bool still_working(const std::stop_token& stop, std::chrono::milliseconds time) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    wake.wait_for(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
}

}  // namespace

Rescue::Rescue(std::function<int()> save) : save_(std::move(save)) {
    try {
        thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
    } catch (const std::system_error&) {  // no more threads: the work is waited for
    }
}

Rescue::~Rescue() = default;

void Rescue::watch(const std::stop_token& stop) const {
    while (!interrupted())
        if (!still_working(stop, look_interval)) return;
    if (!still_working(stop, rescue_patience)) return;
    int exit_code = exit_failed;
    try {
        omp_set_num_threads(1);  // of this thread's loops: the others are busy, and there may be no more
        exit_code = save_();
    } catch (const std::exception& error) {
        print_error(error.what());
    }
    std::fflush(stdout);
    _exit(exit_code);  // exit() would destroy what the tracing threads use
}

}  // namespace raywalk
