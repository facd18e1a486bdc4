// Ctrl-C and SIGTERM: a command with something to save asks for the chance to finish early.
#pragma once

#include <atomic>

namespace raywalk {

// From now on SIGINT, SIGTERM and SIGHUP end the program at once with exit code 130 and a message. SIGPIPE is ignored,
// so that writing to a closed pipe fails with an error that is reported.
void catch_interrupts();

// While one lives, the first signal only sets the flag; one more than half a second later ends the program at once.
// Repeats within half a second count as the same signal.
class GracefulInterrupts {
  public:
    GracefulInterrupts();
    ~GracefulInterrupts();
    GracefulInterrupts(const GracefulInterrupts&) = delete;
    GracefulInterrupts& operator=(const GracefulInterrupts&) = delete;
};

// While one lives beside a GracefulInterrupts, no signal ends the program (but SIGKILL): what is being saved is saved.
class UnbreakableSaving {
  public:
    // `appears_whole` false: into a pipe, which may never take it; nothing is changed then.
    explicit UnbreakableSaving(bool appears_whole);
    ~UnbreakableSaving();
    UnbreakableSaving(const UnbreakableSaving&) = delete;
    UnbreakableSaving& operator=(const UnbreakableSaving&) = delete;
};

// Set once a signal has come while a GracefulInterrupts lived.
const std::atomic<bool>& interrupted();

}  // namespace raywalk
