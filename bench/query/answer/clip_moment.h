#pragma once

#include <cstddef>
#include <optional>

#include "bench/query/input/input.h"

namespace cscd::bench {

// A moment of a clip: inside interval `interval`, at the share `time` of it.
struct ClipMoment {
  std::size_t interval = 0;
  double time = 0;
};

// Returns the number by which people know the moment. Of a model file, frames are those of the file's time
// line (frame_at); of other inputs, they count from frame 0.
double frame_of(const Input& input, const ClipMoment& moment);
// Returns the seconds from the clip's start; nothing where the input does not tell its rate.
std::optional<double> second_of(const Input& input, const ClipMoment& moment);

}  // namespace cscd::bench
