#include "app/display/no_display.h"

#include <cstdlib>

namespace raywalk {

std::string vulkan_driver_advice() {
    // The loader takes the first, and the older name where that is not set.
    for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
        if (const char* value = std::getenv(variable); value != nullptr && *value != '\0')
            return std::string("\n  ") + variable + " names the only drivers that may be used, '" + value +
                   "', and none of them serves: correct it or unset it.";
    return "\n  On Debian: apt install mesa-vulkan-drivers (a software driver, works everywhere).";
}

}  // namespace raywalk
