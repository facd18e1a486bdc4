// Ends by a fault of memory, as a decoder that breaks.
#include <csignal>

int main() {
    std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would end it by an exit code
    std::raise(SIGSEGV);
    return 0;
}
