// Ctrl-C and SIGTERM: a command with something to save asks for the chance to finish early.
#pragma once

#include <atomic>

namespace raywalk {

// From now on SIGINT, SIGTERM and SIGHUP end the program at once with exit code 130 and a message. SIGPIPE is ignored,
// so that writing to a closed pipe fails with an error that is reported.
void catch_interrupts();

// While one lives, the first signal only sets the flag; the second ends the program at once.
class GracefulInterrupts {
  public:
    GracefulInterrupts();
    ~GracefulInterrupts();
    GracefulInterrupts(const GracefulInterrupts&) = delete;
    GracefulInterrupts& operator=(const GracefulInterrupts&) = delete;
};

// Set once a signal has come while a GracefulInterrupts lived.
const std::atomic<bool>& interrupted();

}  // namespace raywalk
