// The walk as text: "12w 3R t q" is twelve steps forward, three turns to the right, a toggled projection, the end.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "app/walk/walk.h"

namespace raywalk {

// One press of one key. A count in the text makes so many presses.
using WalkScript = std::vector<WalkKey>;

inline constexpr std::size_t walk_script_presses = 1'000'000;  // the most that one script may hold

// Letters of WalkKey, each with a count of 1.. before it if need be, blanks anywhere between them. Throws InputError
// with the place in the text and a caret; `name` stands for the file ("--keys").
WalkScript parse_walk_script(std::string_view text, std::string_view name);

}  // namespace raywalk
