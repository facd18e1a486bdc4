// Preloaded, makes a machine that has no Vulkan library: opening one fails, everything else opens as it does.
#include <dlfcn.h>

#include <cstring>

extern "C" void* dlopen(const char* file, int mode) {
    using Open = void* (*)(const char*, int);
    static const auto real = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "dlopen"));
    if (file && std::strstr(file, "libvulkan")) return nullptr;
    return real(file, mode);
}
