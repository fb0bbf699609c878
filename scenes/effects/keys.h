#pragma once

#include <limits>
#include <vector>

#include "scenes/shape/key_curve.h"
#include "scenes/shape/parameters.h"

namespace cscd::scenes {

// A weight that fades in after `start` and has faded out at `end`. Times are in frames.
struct Envelope {
  double start = 0;
  double end = std::numeric_limits<double>::infinity();
  double fade = 0;    // time to fade in, and to fade out
  double weight = 1;  // weight between both

  // Reads the parameters start, end, fade and weight, each of them optional. Throws InputError unless end
  // is after start.
  static Envelope from(const Parameters& parameters);
  double at(double frame) const;
};

// Returns the rows of an effect's parameters with those of an envelope after them.
std::vector<ParameterRow> with_envelope(std::vector<ParameterRow> rows);

}  // namespace cscd::scenes
