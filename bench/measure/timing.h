#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/input/input.h"
#include "bench/measure/contestant.h"
#include "bench/measure/verification.h"
#include "bench/record/record.h"

namespace cscd::bench {

struct TimingPlan {
  std::vector<std::size_t> counted;  // all of the warm-up, ascending; those verified are among them
  std::vector<std::size_t> timed;    // of these
  std::size_t repetitions;
  std::uint64_t seed;
};

// A strategy that did not repeat itself: its times are void.
struct Unrepeatable {
  std::size_t contestant;
  std::string failure;
};

// Streams all positions of both ends once from main memory, which leaves them as near as whoever has just
// moved them would. Returns milliseconds. (Where caches cannot be emptied, from where they are.)
double stream_positions(const Motion& motion);

// One warm-up pass that takes the counters and digests of the counted intervals, then the timed repetitions.
// Every interval is given to all strategies in turn, in a random order drawn anew each time, so that drift of
// the machine hits all alike. Stops at the first strategy whose counters differ from those verified, or whose
// contacts differ between repetitions.
// Before each timed query all positions are streamed; how long that took is the column `streaming`.
std::optional<Unrepeatable> time_contestants(Input& input, std::span<Contestant> contestants,
                                             const TimingPlan& plan, const VerificationOutcome& verified,
                                             std::vector<StrategyRecord>& records);

}  // namespace cscd::bench
