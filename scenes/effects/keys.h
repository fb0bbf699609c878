#pragma once

#include <limits>

#include "scenes/shape/key_curve.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A weight between 0 and 1 that fades in after `start` and is gone again at `end`, in frames.
struct Envelope {
  double start = 0;
  double end = std::numeric_limits<double>::infinity();
  double fade = 0;    // how long either takes
  double weight = 1;  // in between

  // Of the parameters start, end, fade and weight, each optional. Throws InputError where they leave no time.
  static Envelope from(const Parameters& parameters);
  double at(double frame) const;
};

}  // namespace cscd::scenes
