#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cscd {

// Returns the texts of a range one after the other, with `between` from each to the next.
template <class Texts>
std::string joined(const Texts& texts, std::string_view between = ", ") {
  std::string out;
  bool first = true;
  for (const auto& text : texts) {
    if (!first) out += between;
    out += text;
    first = false;
  }
  return out;
}

// The first `most` texts in quotes, and how many more there are: "'walk', 'run' and 3 more".
template <class Texts>
std::string first_of(const Texts& texts, std::size_t most, std::string_view quote = "'") {
  std::string out;
  std::size_t count = 0;
  for (const auto& text : texts)
    if (++count <= most) (((out += count > 1 ? ", " : "") += quote) += text) += quote;
  return count > most ? out + " and " + std::to_string(count - most) + " more" : out;
}

}  // namespace cscd
