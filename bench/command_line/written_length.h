#pragma once

#include <string>

namespace cscd::bench {

// What the lengths of an input are measured in.
struct LengthScale {
  double mean_edge = 0;             // of the pose at rest, in the units of the positions
  double centimetres_per_unit = 0;  // of the positions; 0 where the input does not tell its unit
};

// A length as users write it: "0.01" in the units of the positions, "5mm" where the input tells its unit, or
// "0.2e" in mean edges of the pose at rest.
struct WrittenLength {
  std::string text = {};  // empty where nothing was written
  double number = 0;      // finite, at least 0
  bool in_edges = false;
  double centimetres = 0;  // of the unit behind the number; 0 for none

  bool is_given() const { return !text.empty(); }
  // In the units of the positions. A length with a unit needs a scale that knows one (require_unit).
  double length(const LengthScale& scale) const {
    return in_edges          ? number * scale.mean_edge
           : centimetres > 0 ? number * (centimetres / scale.centimetres_per_unit)
                             : number;
  }
};

// Reads a length. Throws InputError, naming the option, for a text that is none, and for a number that is
// negative or not finite.
WrittenLength parse_length(const std::string& option, const std::string& text);

}  // namespace cscd::bench
