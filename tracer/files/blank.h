// What stands between the words of a line, in scenes and OBJ files alike.
#pragma once

namespace raywalk {

// The carriage return is one of them: lines may end with it. Most characters that are asked are above the blanks: one
// comparison tells.
constexpr bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' ' && (c == ' ' || c == '\t' || c == '\r'); }

}  // namespace raywalk
