#pragma once

#include <optional>
#include <string_view>

namespace cscd::scenes {

// Reads a word of a text file that has to be a number as a whole: digits with a point, a sign or an exponent.
// Returns nullopt for anything else, such as "1,5", "0x10", "1.#IND" and "2.0f". The words nan, inf and
// infinity are numbers that are not finite, and so is what is too large for a double; what is too small for
// one is 0.
std::optional<double> number_of(std::string_view word);

}  // namespace cscd::scenes
