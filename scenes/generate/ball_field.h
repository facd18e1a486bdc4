// The scene of the sculpture among thousands of balls.
#pragma once

#include <string>

namespace generate {

// Scene text with `count` balls.
std::string ball_field_scene(int count);

}  // namespace generate
