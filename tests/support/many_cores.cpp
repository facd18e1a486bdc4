// Preloaded into a program it makes the machine look as if it had RAYWALK_CORES cores.
#include <sys/sysinfo.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

namespace {
int pretended_cores() {
    const char* cores = std::getenv("RAYWALK_CORES");
    return cores != nullptr ? std::atoi(cores) : 1;
}
}  // namespace

unsigned std::thread::hardware_concurrency() noexcept { return static_cast<unsigned>(pretended_cores()); }
extern "C" int get_nprocs() noexcept { return pretended_cores(); }
extern "C" int get_nprocs_conf() noexcept { return pretended_cores(); }
