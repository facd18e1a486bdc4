// Ends by a fault of memory, as a decoder that breaks.
#include <csignal>

int main() {
    std::raise(SIGSEGV);
    return 0;
}
