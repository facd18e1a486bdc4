// "Did you mean": the nearest of a few known words.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace raywalk {

// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal string alignment, case
// ignored).
std::size_t edit_distance(std::string_view a, std::string_view b);

// The known word nearest to `word`, if it is near enough to be a slip: about one edit in three letters, three at most.
std::optional<std::string_view> nearest_word(std::string_view word, std::span<const std::string_view> known);

// "did you mean 'X'?" of the nearest word, or nothing where none is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

// The same, or else "expected one of A, B, C".
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

// "A, B, C"
std::string listed(std::span<const std::string_view> words);

}  // namespace raywalk
