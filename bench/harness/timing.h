#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/harness/verification.h"
#include "bench/inputs/input.h"
#include "bench/records/record.h"

namespace cscd::bench {

// A strategy that did not repeat itself: its times are void.
struct Unrepeatable {
  std::size_t contestant;
  std::string failure;
};

// What one pass over the counted intervals gave.
struct WarmUp {
  std::vector<std::size_t> counted;          // ascending
  std::vector<std::vector<Report>> reports;  // [contestants][counted]
  // Intervals on which two rows gave different answers where both promise the same: complete rows have to
  // find the same contacts; they and, from an embedded start, rows that promise the first contact have to
  // find the same first time. The timed elementary test may be to blame, so these intervals are to be judged
  // with the exact one.
  std::vector<std::size_t> disagreeing;
  // Intervals on which rows that promise the first contact differ, as they may from a start that is not
  // embedded.
  std::vector<std::size_t> excused;
  std::optional<Unrepeatable> unrepeatable;
};

// Answers the counted intervals once with every strategy, which takes their counters and digests and brings
// caches into the state of a strategy in use. Stops at the first strategy whose counters on a judged interval
// differ from those when it was judged.
WarmUp warm_up(Input& input, std::span<Contestant> contestants, std::span<const std::size_t> counted,
               const Verifier& verifier, std::vector<StrategyRecord>& records);

struct TimingPlan {
  std::vector<std::size_t> timed;  // ascending; all of them counted in the warm-up and judged by the verifier
  std::size_t repetitions;
  std::uint64_t seed;
};

// Streams all positions of both ends once from main memory, which leaves them as warm in the caches as a
// simulator would leave them. Returns milliseconds. (Where caches cannot be emptied, from where they are.)
double stream_positions(const Motion& motion);

// Times the strategies. Each timed interval is given to all strategies in turn, in a random order drawn anew
// every time, so that drift of the machine hits all alike. Stops at the first strategy whose contacts or
// counters differ from the warm-up's. Before each timed query all positions are streamed; how long that took
// is the column `streaming`. After all queries, the exact test whether the start is embedded is timed as
// often. What it took is the stage `embedding` of the strategies that promise the first contact, since they
// promise nothing without it. The stage `start` of the row that answers from starts that are not known is
// what its own exact test of the pairs that may cross there takes, beside its query. Throws InputError where
// an interval is to be timed that was not judged.
std::optional<Unrepeatable> time_contestants(Input& input, std::span<Contestant> contestants,
                                             const TimingPlan& plan, const Verifier& verifier,
                                             const WarmUp& warm_up, std::vector<StrategyRecord>& records);

}  // namespace cscd::bench
