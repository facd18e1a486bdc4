#include <cstddef>
#include <cstdint>

#include "tests/fuzz/app_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    raywalk::fuzz::command_line({reinterpret_cast<const char*>(data), size});
    return 0;
}
