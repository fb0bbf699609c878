#pragma once

#include <string>

#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A smooth curve through keys. A key is a row of a frame and values. The curve is a cubic Hermite curve
// with slopes that do not overshoot (Fritsch, Butland, "A method for constructing local monotone piecewise
// cubic interpolants", SIAM J. Sci. Stat. Comput. 1984). It is constant before the first key and after the
// last.
class KeyCurve {
 public:
  // Throws InputError, whose text begins with `who`, if there are no keys or their frames do not increase.
  KeyCurve(Parameters::Table keys, const std::string& who);

  // A curve that repeats smoothly with a period in frames. The keys must lie within less than one period;
  // throws InputError otherwise.
  static KeyCurve periodic(const Parameters::Table& keys, double period, const std::string& who);

  double first_frame() const { return keys_.front()[0]; }
  double last_frame() const { return keys_.back()[0]; }
  // The value of a column of the keys, counted from 1, at a frame.
  double at(double frame, std::size_t column) const;

 private:
  double slope(std::size_t key, std::size_t column) const;

  Parameters::Table keys_;
  double origin_ = 0, period_ = 0;  // the first key and the period of a curve that repeats; else 0
};

}  // namespace cscd::scenes
