#pragma once

#include <span>
#include <vector>

#include "bench/input/input.h"
#include "bench/measure/contestant.h"
#include "bench/record/record.h"

namespace cscd::bench {

// The counters of one strategy on the verified intervals, in their order: the timed run must repeat them.
using VerifiedReports = std::vector<Report>;

struct VerificationOutcome {
  VerificationRecord record;
  std::vector<VerifiedReports> reports;  // one a contestant
};

// Judges every contestant's contacts on the given intervals against those of the complete reference, both
// with the exact elementary test; and the timed elementary test on the reference's pairs. `exact` and `timed`
// are the tests that the contestants were made with.
VerificationOutcome verify_contestants(Input& input, std::span<Contestant> contestants,
                                       const ElementaryTest& exact, const ElementaryTest& timed,
                                       std::vector<std::size_t> intervals);

// Every K-th interval of a range.
std::vector<std::size_t> every_kth(const IntervalRange& range, std::size_t k);

}  // namespace cscd::bench
