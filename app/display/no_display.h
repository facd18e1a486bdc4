// No Vulkan library, no device, no display (exit code 4), and what to do about it.
#pragma once

#include <stdexcept>
#include <string>

namespace raywalk {

// The message says what to do.
class NoDisplayError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// What to do where no driver serves: correct the variable that names the drivers, or install one. Starts a new line.
std::string vulkan_driver_advice();

}  // namespace raywalk
