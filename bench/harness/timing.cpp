#include "bench/harness/timing.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>
#include <stdexcept>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "bench/harness/contestant.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/detect/start/embedding.h"
#include "core/fast/drvbc_fast.h"
#include "core/geometry/simd_doubles.h"

namespace cscd::bench {
namespace {

// Culling must not depend on the elementary test behind it; otherwise the verified strategy is not the timed
// one. A row that looks for the first contact alone culls by the times that the test finds. How many feature
// pairs the filter leaves is not compared: the filter runs in the precision that the test can take
// (ElementaryTest::single_precision_first).
bool same_culling(const Report& a, const Report& b) {
  return a.cull.bvot == b.cull.bvot && a.cull.pctp == b.cull.pctp &&
         a.cull.contour_box_tests == b.cull.contour_box_tests &&
         a.pairs.adjacent_pctp == b.pairs.adjacent_pctp &&
         a.pairs.relative_dropped == b.pairs.relative_dropped &&
         a.pairs.feature_pairs == b.pairs.feature_pairs;
}

struct Answer {
  Report report;
  std::string digest;
  std::optional<double> first;  // time of the earliest contact
};

// Sorting and digesting happen outside the detector's clock.
Answer answer(Contestant& contestant, const Step& step, ContactSet& found) {
  const Report report = contestant.timed->detect(step, found);
  found.sort();
  if (contestant.row.first) keep_first(found);
  const auto first = found.contacts.empty() ? std::nullopt : std::optional(found.contacts.front().time);
  return {report, digest(found), first};
}

// Reads more than the caches hold.
void drive_from_caches() {
  static const std::vector<std::uint64_t> much(std::size_t{1} << 23, 1);  // 64 MiB
  [[maybe_unused]] const volatile std::uint64_t kept =
      std::accumulate(much.begin(), much.end(), std::uint64_t{0});
}

// Whether rows that promise the same have answered the same.
template <class StartsEmbedded>
bool agree(std::span<const Contestant> contestants, std::span<const Answer> answers,
           const StartsEmbedded& starts_embedded) {
  const Answer *complete = nullptr, *first = nullptr;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const StrategyRow& row = contestants[c].row;
    if (row.strategy->own_test || row.strategy->guarantee != Guarantee::complete) continue;
    if (first != nullptr && first->first != answers[c].first) return false;
    first = &answers[c];
    if (row.first) continue;
    if (complete != nullptr && complete->digest != answers[c].digest) return false;
    complete = &answers[c];
  }
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const Guarantee guarantee = contestants[c].row.strategy->guarantee;
    if (!needs_embedded_start(guarantee)) continue;
    const bool all =
        guarantee == Guarantee::all_from_embedded && !contestants[c].row.first && complete != nullptr;
    if (all && complete->digest != answers[c].digest) return !starts_embedded();
    if (first != nullptr && first->first != answers[c].first) return !starts_embedded();
    first = &answers[c];
  }
  return true;
}

// The place of an interval among the counted ones, which ascend.
std::size_t place_of(std::size_t interval, const std::vector<std::size_t>& counted) {
  return static_cast<std::size_t>(std::ranges::lower_bound(counted, interval) - counted.begin());
}

// Throws std::logic_error where what was timed says of a start what the verifier's plain test does not say.
void expect_verified(bool embedded, const Verifier& verifier, std::size_t interval, const Input& input) {
  if (embedded != verifier.starts_embedded(interval))
    throw std::logic_error("the timed test of the start of interval " + std::to_string(interval) + " of " +
                           input.name + " says " + (embedded ? "embedded" : "not embedded") +
                           ", and the verifier's says the opposite");
}

// Times on all timed intervals what it takes to know whether the start is embedded: the test of the start,
// for the rows that rely on it, and for the row that answers from starts that are not known, what seeing the
// start adds to its query. Both are timed in a pass of their own after all queries. In between, their data
// would push that of the strategies out of the caches, and the next query would be slower for that.
void time_starts(Input& input, std::span<const Contestant> contestants, std::span<const std::size_t> timed,
                 const Verifier& verifier, const WarmUp& warm_up, EmbeddingTest& test, std::size_t repetition,
                 std::vector<StrategyRecord>& records) {
  ContactSet found;
  Crossings start;
  for (const std::size_t i : timed) {
    scenes::ClipInterval interval = input.clip->load(i);
    stream_positions(interval.motion);
    const Stopwatch testing;
    const bool embedded = test.embedded(interval.motion.start());
    const double taken = testing.milliseconds();
    expect_verified(embedded, verifier, i, input);
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      const Strategy& strategy = *contestants[c].row.strategy;
      if (needs_embedded_start(strategy.guarantee))
        append_time("embedding", taken, records[c].ms, repetition);
      if (&strategy != &complete_fallback() || contestants[c].row.first) continue;
      lead_up(strategy, *contestants[c].timed, input, i);
      interval = input.clip->load(i);
      stream_positions(interval.motion);
      Step step = input.step(interval);
      step.crossings = &start;
      const Report report = contestants[c].timed->detect(step, found);
      found.sort();
      if (digest(found) != records[c].digests[place_of(i, warm_up.counted)])
        throw std::logic_error("interval " + std::to_string(i) + " of " + input.name + ": " +
                               std::string(strategy.name) + " finds other contacts when it sees the start");
      expect_verified(start.total == 0, verifier, i, input);
      append_time("start", report.start_ms, records[c].ms, repetition);
    }
  }
}

}  // namespace

double stream_positions(const Motion& motion) {
  const std::span<const Vec3> ends[] = {motion.start(), motion.end()};
#ifdef __SSE2__
  for (const std::span<const Vec3> points : ends)
    for (const Vec3& p : points) _mm_clflush(&p);
  _mm_mfence();
#endif
  const Stopwatch streaming;
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
  return streaming.milliseconds();
}

WarmUp warm_up(Input& input, std::span<Contestant> contestants, std::span<const std::size_t> counted,
               const Verifier& verifier, std::vector<StrategyRecord>& records) {
  Progress progress("counting " + input.name, counted.size());
  EmbeddingTest embedding(input.mesh, input.reference);
  WarmUp out{
      {counted.begin(), counted.end()}, std::vector<std::vector<Report>>(contestants.size()), {}, {}, {}};
  ContactSet found;
  std::vector<Answer> answers(contestants.size());
  for (const std::size_t i : counted) {
    scenes::ClipInterval interval = input.clip->load(i);
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      lead_up(*contestants[c].row.strategy, *contestants[c].timed, input, i);
      interval = input.clip->load(i);
      answers[c] = answer(contestants[c], input.step(interval), found);
      append_counts(answers[c].report, found, records[c].counts);
      records[c].digests.push_back(answers[c].digest);
      records[c].first_times.push_back(answers[c].first);
      out.reports[c].push_back(answers[c].report);
      if (verifier.has_judged(i) && !contestants[c].row.first &&
          !same_culling(answers[c].report, verifier.report(c, i))) {
        out.unrepeatable = {c,
                            "interval " + std::to_string(i) + ": culls otherwise than when it was verified"};
        return out;
      }
    }
    const auto starts_embedded = [&] {
      bool holds = embedding.embedded(interval.motion.start());
      if (input.thickness.length > 0)  // with a thickness, promises are about clear starts
        for (const Answer& said : answers) holds = holds && said.first != 0.0;
      if (!holds) out.excused.push_back(i);
      return holds;
    };
    if (!agree(contestants, answers, starts_embedded)) out.disagreeing.push_back(i);
    progress.advance();
  }
  return out;
}

std::optional<Unrepeatable> time_contestants(Input& input, std::span<Contestant> contestants,
                                             const TimingPlan& plan, const Verifier& verifier,
                                             const WarmUp& warm_up, std::vector<StrategyRecord>& records) {
  for (const std::size_t i : plan.timed)
    if (!verifier.has_judged(i))
      throw InputError("interval " + std::to_string(i) + " of " + input.name +
                       " is to be timed but was not verified; verify every timed interval");
  Progress progress("timing " + input.name, plan.repetitions * plan.timed.size());
  EmbeddingTest start_test = make_embedding_test(input.setup(elementary_test_named("exact")));
  ContactSet found;
  std::mt19937_64 random(plan.seed);
  const bool leads = std::ranges::any_of(
      contestants, [](const Contestant& c) { return c.row.strategy->kind == StrategyKind::adaptive; });
  std::vector<std::size_t> order(contestants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t repetition = 0; repetition < plan.repetitions; ++repetition) {
    for (const std::size_t i : plan.timed) {
      const std::size_t row = place_of(i, warm_up.counted);
      for (const Contestant& contestant : contestants)
        lead_up(*contestant.row.strategy, *contestant.timed, input, i);
      // A lead brings what its strategy works on into the caches, from where other strategies drive it
      // otherwise.
      if (leads) drive_from_caches();
      const scenes::ClipInterval interval = input.clip->load(i);
      shuffle(order, random);
      for (const std::size_t c : order) {
        append_time("streaming", stream_positions(interval.motion), records[c].ms, repetition);
        const Answer timed = answer(contestants[c], input.step(interval), found);
        append_times(timed.report.ms, records[c].ms, repetition);
        if (timed.digest != records[c].digests[row] || !same_culling(timed.report, warm_up.reports[c][row]) ||
            timed.report.pairs.elementary_tests != warm_up.reports[c][row].pairs.elementary_tests)
          return Unrepeatable{c, "interval " + std::to_string(i) +
                                     ": other contacts or counters in repetition " +
                                     std::to_string(repetition) + " than before"};
      }
      progress.advance();
    }
  }
  // The tests of the starts come after all queries. Between two repetitions they would drive from the caches
  // what a strategy keeps, and the first query of the next repetition would pay for that.
  for (std::size_t repetition = 0; repetition < plan.repetitions; ++repetition)
    time_starts(input, contestants, plan.timed, verifier, warm_up, start_test, repetition, records);
  return std::nullopt;
}

}  // namespace cscd::bench
