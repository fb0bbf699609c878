#pragma once

#include <string>

#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A smooth curve through keys, rows of a frame and values. Cubic Hermite with slopes that do not overshoot
// (Fritsch, Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci.
// Stat. Comput. 1984); constant before the first key and after the last.
class KeyCurve {
 public:
  // Throws InputError, beginning with `who`, when there are no keys or their frames do not increase.
  KeyCurve(Parameters::Table keys, const std::string& who);

  // Repeats for ever, smoothly; the keys lie within less than one period.
  static KeyCurve periodic(const Parameters::Table& keys, double period, const std::string& who);

  double first_frame() const { return keys_.front()[0]; }
  double last_frame() const { return keys_.back()[0]; }
  double at(double frame, std::size_t column) const;

 private:
  double slope(std::size_t key, std::size_t column) const;

  Parameters::Table keys_;
  double origin_ = 0, period_ = 0;  // of a curve that repeats; else 0
};

}  // namespace cscd::scenes
