#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace cscd {

// Returns the smallest number of edits that turn one word into the other. An edit leaves out,
// adds or replaces one letter, or swaps two neighbouring letters (the optimal string
// alignment distance, counted in bytes).
std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the name that `word` was probably meant to be: the name with the smallest edit distance, and the
// first of several such names. The distance may be at most a third of the length of `word`, or 1 if that is
// more. Returns an empty view if no name is that near, or if `word` is longer than 64 letters.
std::string_view closest_name(std::string_view word, std::span<const std::string_view> names);

// Returns "; did you mean NAME?", to be appended to an error message, or an empty string if no name is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace cscd
