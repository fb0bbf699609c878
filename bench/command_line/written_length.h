#pragma once

#include <string>

namespace cscd::bench {

// A length as users write it: "0.01" in the units of the positions, or "0.2e" in mean edges of the pose at
// rest.
struct WrittenLength {
  std::string text = {};  // empty where nothing was written
  double number = 0;      // finite, at least 0
  bool in_edges = false;

  bool is_given() const { return !text.empty(); }
  double length(double mean_edge) const { return in_edges ? number * mean_edge : number; }
};

// Reads a length. Throws InputError, naming the option, for a text that is none, and for a number that is
// negative or not finite.
WrittenLength parse_length(const std::string& option, const std::string& text);

}  // namespace cscd::bench
