// The walk as text: "12w 3R t q" is twelve steps forward, three turns to the right, a toggled projection, the end.
#pragma once

#include <string_view>
#include <vector>

#include "tracer/picture/camera.h"

namespace raywalk {

enum class WalkKey : char {
    forward = 'w',
    back = 's',
    left = 'a',
    right = 'd',
    turn_up = 'U',
    turn_down = 'D',
    turn_left = 'L',
    turn_right = 'R',
    toggle = 't',
    quit = 'q',
};

// One press of one key. A count in the text makes so many presses.
using WalkScript = std::vector<WalkKey>;

inline constexpr std::size_t walk_script_presses = 1'000'000;  // the most that one script may hold

// Letters of WalkKey, each with a count of 1.. before it if need be, blanks anywhere between them. Throws InputError
// with the place in the text and a caret; `name` stands for the file ("--keys").
WalkScript parse_walk_script(std::string_view text, std::string_view name);

// The camera after one press. `quit` changes nothing.
Camera pressed(const Camera& camera, WalkKey key);
// The camera after the presses up to the first `quit`.
Camera pressed(const Camera& camera, const WalkScript& script);

}  // namespace raywalk
