#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace cscd {

// How many letters must be left out, added, replaced, or swapped with their neighbour to make one word of the
// other (the optimal string alignment distance, in bytes).
std::size_t edit_distance(std::string_view a, std::string_view b);

// The name that `word` was probably meant to be: the nearest one, the first of several, if at most a third of
// the letters differ, and at least one may. Empty where no name is that near.
std::string_view closest_name(std::string_view word, std::span<const std::string_view> names);

// "; did you mean NAME?", to be put behind what an error says; empty where no name is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace cscd
