#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "bench/input.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// What a strategy needs beside time.
struct Footprint {
  // Resident memory over that before the strategy was made: at most while it was made and answered twice, and
  // what it kept then. Absent where the kernel does not say.
  std::optional<std::uint64_t> peak_bytes, held_bytes;
  // User-mode instructions of a query, mean over the intervals. Absent where the machine does not count them,
  // as most virtual machines do not, and where several threads share the work.
  std::optional<double> instructions;
};

// A strategy made and measured while it was made and answered one interval twice.
struct Made {
  Prepared prepared;
  Footprint footprint;  // without instructions
  double make_ms = 0;   // before it answered
};
Made make_measured(Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                   std::size_t interval);

// Makes the strategy anew and runs it on the intervals, of which there is at least one.
Footprint measure_footprint(Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                            std::span<const std::size_t> intervals);

}  // namespace cscd::bench
