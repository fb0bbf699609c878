#include "bench/measure/timing.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <random>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "bench/output/progress.h"
#include "core/base/random.h"
#include "core/geometry/lanes.h"

namespace cscd::bench {
namespace {

// Culling must not depend on the elementary test behind it; otherwise the verified strategy is not the timed
// one.
bool same_culling(const Report& a, const Report& b) {
  return a.cull.bvot == b.cull.bvot && a.cull.pctp == b.cull.pctp &&
         a.cull.contour_box_tests == b.cull.contour_box_tests &&
         a.pairs.adjacent_pctp == b.pairs.adjacent_pctp &&
         a.pairs.relative_dropped == b.pairs.relative_dropped &&
         a.pairs.feature_pairs == b.pairs.feature_pairs &&
         a.pairs.elementary_tests == b.pairs.elementary_tests;
}

struct Answer {
  Report report;
  std::string digest;
};

// Sorting and digesting happen outside the detector's clock.
Answer answer(Contestant& contestant, const scenes::ClipInterval& interval, ContactSet& found) {
  const Report report =
      contestant.timed->detect(interval.motion, interval.bones ? &*interval.bones : nullptr, found);
  found.sort();
  return {report, digest(found)};
}

}  // namespace

double stream_positions(const Motion& motion) {
  const std::span<const Vec3> ends[] = {motion.start(), motion.end()};
#ifdef __SSE2__
  for (const std::span<const Vec3> points : ends)
    for (const Vec3& p : points) _mm_clflush(&p);
  _mm_mfence();
#endif
  const auto begin = std::chrono::steady_clock::now();
  Lane8 sum = {};
  for (const std::span<const Vec3> points : ends) {
    const auto* const first = reinterpret_cast<const std::byte*>(points.data());
    for (std::size_t i = 0; i + sizeof sum <= points.size_bytes(); i += sizeof sum) {
      Lane8 some;
      std::memcpy(&some, first + i, sizeof some);
      sum += some;
    }
  }
  [[maybe_unused]] const volatile double kept = sum[0];  // or nothing would be read
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std::optional<Unrepeatable> time_contestants(Input& input, std::span<Contestant> contestants,
                                             const TimingPlan& plan, const VerificationOutcome& verified,
                                             std::vector<StrategyRecord>& records) {
  Progress progress("timing " + input.name, plan.counted.size() + plan.repetitions * plan.timed.size());
  ContactSet found;
  std::vector<std::vector<Report>> warm_ups(contestants.size());

  auto next_verified = verified.record.intervals.begin();
  for (const std::size_t i : plan.counted) {
    const scenes::ClipInterval interval = input.clip->load(i);
    const bool was_verified = next_verified != verified.record.intervals.end() && *next_verified == i;
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      const Answer warm_up = answer(contestants[c], interval, found);
      append_counts(warm_up.report, found, records[c].counts);
      records[c].digests.push_back(warm_up.digest);
      warm_ups[c].push_back(warm_up.report);
      const auto row = static_cast<std::size_t>(next_verified - verified.record.intervals.begin());
      if (was_verified && !same_culling(warm_up.report, verified.reports[c][row]))
        return Unrepeatable{c,
                            "interval " + std::to_string(i) + ": culls otherwise than when it was verified"};
    }
    next_verified += was_verified;
    progress.advance();
  }

  std::mt19937_64 random(plan.seed);
  std::vector<std::size_t> order(contestants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t repetition = 0; repetition < plan.repetitions; ++repetition)
    for (const std::size_t i : plan.timed) {
      const auto row =
          static_cast<std::size_t>(std::ranges::lower_bound(plan.counted, i) - plan.counted.begin());
      const scenes::ClipInterval interval = input.clip->load(i);
      shuffle(order, random);
      for (const std::size_t c : order) {
        append_time("streaming", stream_positions(interval.motion), records[c].ms, repetition);
        const Answer timed = answer(contestants[c], interval, found);
        append_times(timed.report.ms, records[c].ms, repetition);
        if (timed.digest != records[c].digests[row] || !same_culling(timed.report, warm_ups[c][row]))
          return Unrepeatable{c, "interval " + std::to_string(i) +
                                     ": other contacts or counters in repetition " +
                                     std::to_string(repetition) + " than before"};
      }
      progress.advance();
    }
  return std::nullopt;
}

}  // namespace cscd::bench
