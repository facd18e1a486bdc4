// What the fuzzers feed, and what must hold whatever they feed. A broken promise aborts. The tests run the same on the
// committed corpus.
#pragma once

#include <string_view>

namespace raywalk::fuzz {

void scene(std::string_view input);
void obj(std::string_view input);

}  // namespace raywalk::fuzz
