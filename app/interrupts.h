// Ctrl-C and SIGTERM: the first asks the program to finish early, the second ends it at once.
#pragma once

#include <atomic>

namespace raywalk {

// From now on the first SIGINT or SIGTERM only sets the flag; the next has its default effect. SIGPIPE is ignored, so
// that writing to a closed pipe fails with an error that is reported.
void catch_interrupts();
// Set once a signal has come.
const std::atomic<bool>& interrupted();

}  // namespace raywalk
