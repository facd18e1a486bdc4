// What the fuzzers feed to the program's own readers: walk scripts and command lines. A broken promise aborts.
#pragma once

#include <string_view>

namespace raywalk::fuzz {

void walk_script(std::string_view input);
// One word a line.
void command_line(std::string_view input);

}  // namespace raywalk::fuzz
