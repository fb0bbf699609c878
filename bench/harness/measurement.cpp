#include "bench/harness/measurement.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "bench/harness/footprint.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/fast/drvbc_fast.h"
#include "core/geometry/simd_doubles.h"

namespace cscd::bench {
namespace {

StrategyRecord describe(const Contestant& contestant) {
  StrategyRecord record;
  record.name = contestant.row.name();
  record.source = contestant.row.strategy->source;
  record.guarantee = to_string(contestant.row.strategy->guarantee);
  record.threads = contestant.threads;
  if (contestant.row.strategy->kind == StrategyKind::adaptive) record.lead = kLead;
  record.preparation = contestant.preparation;
  record.footprint = contestant.footprint;
  return record;
}

// Reads more than the caches hold.
void drive_from_caches() {
  static const std::vector<std::uint64_t> much(std::size_t{1} << 23, 1);  // 64 MiB
  [[maybe_unused]] const volatile std::uint64_t kept =
      std::accumulate(much.begin(), much.end(), std::uint64_t{0});
}

// Streams all positions of both ends once from main memory, which leaves them as warm in the caches as a
// simulator would leave them. Returns milliseconds. (Where caches cannot be emptied, from where they are.)
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

// Whether contestants that promise the same have answered the same.
template <class StartsClear, class DigestOf>
bool agree(std::span<const Contestant> contestants, std::span<const std::optional<Answered>> answers,
           const StartsClear& starts_clear, const DigestOf& digest_of) {
  std::optional<std::string> complete;
  std::optional<std::optional<double>> first;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const StrategyRow& row = contestants[c].row;
    if (!answers[c] || row.strategy->own_test || row.strategy->guarantee != Guarantee::complete) continue;
    if (first && *first != answers[c]->first_time()) return false;
    first = answers[c]->first_time();
    if (row.first) continue;
    if (complete && *complete != digest_of(c)) return false;
    complete = digest_of(c);
  }
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    const Guarantee guarantee = contestants[c].row.strategy->guarantee;
    if (!answers[c] || !needs_embedded_start(guarantee)) continue;
    const bool all = guarantee == Guarantee::all_from_embedded && !contestants[c].row.first && complete;
    if (all && *complete != digest_of(c)) return !starts_clear();
    if (first && *first != answers[c]->first_time()) return !starts_clear();
    first = answers[c]->first_time();
  }
  return true;
}

// The place of an interval among the counted ones, which ascend.
std::size_t place_of(std::size_t interval, const SectionResult& result) {
  const std::vector<std::size_t>& counted = result.section.counted;
  return static_cast<std::size_t>(std::ranges::lower_bound(counted, interval) - counted.begin());
}

}  // namespace

double SectionResult::mean_ms(std::size_t contestant) const {
  double sum = 0, queries = 0;
  for (const std::optional<Counted>& one : counted[contestant])
    if (one) sum += one->report.ms.total(), ++queries;
  return queries > 0 ? sum / queries : 0;
}

std::vector<IntervalRange> leads_in_clip(std::size_t intervals) {
  std::vector<IntervalRange> leads;
  for (std::size_t i = 0; i < intervals; ++i) leads.push_back({i - std::min(i, kLead), i});
  return leads;
}

Measurement::Measurement(Setup setup)
    : setup_(std::move(setup)), embedding_(setup_.input.mesh, setup_.input.reference) {
  const StrategyRow reference{&complete_reference()};
  const auto among = std::ranges::find(setup_.contestants, reference, &Contestant::row);
  if (among == setup_.contestants.end())
    own_reference_ = make_contestant(setup_.input, reference, setup_.exact, setup_.timed);
  reference_ = own_reference_ ? &*own_reference_ : &*among;
}

bool Measurement::starts_embedded(std::size_t interval) {
  const auto [place, fresh] = embedded_.try_emplace(interval, false);
  if (fresh) place->second = embedding_.embedded(setup_.input.clip->load(interval).motion.start());
  return place->second;
}

bool Measurement::is_asked(const Section& section, std::size_t contestant, bool is_verified) const {
  return (section.asked.empty() || section.asked[contestant]) &&
         (is_verified || section.reference_answers_all || !is_reference(contestant));
}

scenes::ClipInterval Measurement::lead_to(std::size_t interval, const StrategyRow& row, Detector& detector) {
  lead_up(*row.strategy, detector, setup_.input, setup_.leads[interval]);
  return setup_.input.clip->load(interval);
}

SectionResult& Measurement::count(Section section, const Visit& visit) {
  Input& input = setup_.input;
  const std::span<Contestant> contestants = setup_.contestants;
  SectionResult& out = results_.emplace_back();
  out.section = std::move(section);
  out.verification = unjudged();
  for (const Contestant& contestant : contestants) out.rows.push_back(describe(contestant));
  const std::vector<std::size_t>& counted = out.section.counted;
  out.counted.assign(contestants.size(), std::vector<std::optional<Counted>>(counted.size()));
  input.thickness.length = out.section.thickness;

  Progress progress("verifying " + input.name, counted.size());
  Answers answers(contestants.size());
  for (std::size_t place = 0; place < counted.size(); ++place) {
    const std::size_t i = counted[place];
    const bool is_verified = std::ranges::binary_search(out.section.verified, i);
    std::optional<double>& first_time = out.first_times.emplace_back();
    bool is_told = false;
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      if (!is_asked(out.section, c, is_verified)) {
        answers[c].reset();
        continue;
      }
      if (!answers[c]) answers[c].emplace();
      const StrategyRow& row = contestants[c].row;
      const scenes::ClipInterval interval = lead_to(i, row, *contestants[c].timed);
      ask(*contestants[c].timed, row, input.step(interval), *answers[c]);
      StrategyRecord& record = out.rows[c];
      append_counts(answers[c]->report, answers[c]->found, record.counts);
      record.digests.push_back(digest(answers[c]->found));
      record.first_times.push_back(answers[c]->first_time());
      out.counted[c][place] = {answers[c]->report, record.digests.back()};
      if (!is_told) first_time = answers[c]->first_time();
      is_told = true;
      if (visit) visit(c, i, answers[c]->found);
    }
    const auto starts_clear = [&] {
      bool holds = starts_embedded(i);
      if (input.thickness.length > 0)  // with a thickness, promises are about clear starts
        for (const auto& said : answers) holds = holds && !(said && said->first_time() == 0.0);
      if (!holds) out.verification.excused.push_back(i);
      return holds;
    };
    const bool differ = !agree(contestants, answers, starts_clear,
                               [&](std::size_t c) { return out.counted[c][place]->digest; });
    if (differ) out.verification.disagreeing.push_back(i);
    if (is_verified || differ) first_time = verify(i, answers, out.verification);
    progress.advance();
  }
  return out;
}

void Measurement::time(const Timing& timing) {
  Input& input = setup_.input;
  std::size_t intervals = 0;
  const std::size_t first = std::exchange(timed_results_, results_.size());
  std::vector<std::vector<std::size_t>> repeated;  // [results - first]: the contestants that are timed
  for (std::size_t r = first; r < results_.size(); ++r) {
    const SectionResult& result = results_[r];
    intervals += result.section.timed.size();
    for (const std::size_t i : result.section.timed)
      if (!std::ranges::binary_search(result.section.counted, i))
        throw InputError(setup_.where(i) + " of " + input.name +
                         " is to be timed but was not counted; count every timed interval");
    std::vector<std::size_t>& own = repeated.emplace_back();
    for (std::size_t c = 0; c < setup_.contestants.size(); ++c)
      if (result.mean_ms(c) <= timing.most_ms) own.push_back(c);
  }
  Progress progress("timing " + input.name, timing.repetitions * intervals);
  for (std::size_t repetition = 0; repetition < timing.repetitions; ++repetition)
    for (std::size_t r = 0; r < repeated.size(); ++r) {
      SectionResult& result = results_[first + r];
      input.thickness.length = result.section.thickness;
      for (const std::size_t i : result.section.timed) {
        if (result.verification.ok()) time_queries(result, i, repetition, repeated[r], timing.random);
        progress.advance();
      }
    }
  if (!timing.beside_queries) return;
  // The tests of the starts come after all queries. Between two repetitions they would push out of the caches
  // what a strategy keeps there, and the first query of the next repetition would be slower.
  EmbeddingTest test = make_embedding_test(input.setup(elementary_test_named("exact")));
  for (std::size_t r = first; r < results_.size(); ++r) {
    SectionResult& result = results_[r];
    if (!result.verification.ok()) continue;
    input.thickness.length = result.section.thickness;
    for (std::size_t repetition = 0; repetition < timing.repetitions; ++repetition)
      time_starts(result, repetition, test);
    count_instructions(result);
  }
}

void Measurement::time_queries(SectionResult& result, std::size_t i, std::size_t repetition,
                               const std::vector<std::size_t>& contestants, std::mt19937_64& random) {
  const std::size_t place = place_of(i, result);
  const IntervalRange& lead = setup_.leads[i];
  std::vector<std::size_t> order;
  bool leads = false;
  for (const std::size_t c : contestants) {
    if (!result.counted[c][place]) continue;
    order.push_back(c);
    const Contestant& contestant = setup_.contestants[c];
    lead_up(*contestant.row.strategy, *contestant.timed, setup_.input, lead);
    leads = leads || contestant.row.strategy->kind == StrategyKind::adaptive;
  }
  // A lead brings what its strategy works on into the caches, from where other strategies drive it otherwise.
  if (leads && lead.first < lead.last) drive_from_caches();
  const scenes::ClipInterval interval = setup_.input.clip->load(i);
  shuffle(order, random);
  for (const std::size_t c : order) {
    const Contestant& contestant = setup_.contestants[c];
    append_time("streaming", stream_positions(interval.motion), result.rows[c].ms, repetition);
    ask(*contestant.timed, contestant.row, setup_.input.step(interval), timed_);
    append_times(timed_.report.ms, result.rows[c].ms, repetition);
    const Counted& counted = *result.counted[c][place];
    if (digest(timed_.found) != counted.digest || !same_culling(timed_.report, counted.report) ||
        timed_.report.pairs.elementary_tests != counted.report.pairs.elementary_tests) {
      result.verification.strategies[c].failures.push_back(setup_.where(i) +
                                                           ": other contacts or counters in repetition " +
                                                           std::to_string(repetition) + " than before");
      return;
    }
  }
}

// Throws std::logic_error where what was timed says of a start what the plain test does not say.
void Measurement::expect_verified(bool embedded, std::size_t interval) {
  if (embedded != starts_embedded(interval))
    throw std::logic_error("the timed test of the start of interval " + std::to_string(interval) + " of " +
                           setup_.input.name + " says " + (embedded ? "embedded" : "not embedded") +
                           ", and the verifier's says the opposite");
}

// Times on all timed intervals what it takes to know whether the start is embedded: the test of the start,
// for the rows that rely on it, and for the row that answers from starts that are not known, what seeing the
// start adds to its query.
void Measurement::time_starts(SectionResult& result, std::size_t repetition, EmbeddingTest& test) {
  Crossings start;
  for (const std::size_t i : result.section.timed) {
    scenes::ClipInterval interval = setup_.input.clip->load(i);
    stream_positions(interval.motion);
    const Stopwatch testing;
    const bool embedded = test.embedded(interval.motion.start());
    const double taken = testing.milliseconds();
    expect_verified(embedded, i);
    for (std::size_t c = 0; c < setup_.contestants.size(); ++c) {
      const Contestant& contestant = setup_.contestants[c];
      const Strategy& strategy = *contestant.row.strategy;
      if (needs_embedded_start(strategy.guarantee))
        append_time("embedding", taken, result.rows[c].ms, repetition);
      const std::optional<Counted>& counted = result.counted[c][place_of(i, result)];
      if (&strategy != &complete_fallback() || contestant.row.first || !counted) continue;
      interval = lead_to(i, contestant.row, *contestant.timed);
      stream_positions(interval.motion);
      Step step = setup_.input.step(interval);
      step.crossings = &start;
      ask(*contestant.timed, contestant.row, step, timed_);
      if (digest(timed_.found) != counted->digest)
        throw std::logic_error("interval " + std::to_string(i) + " of " + setup_.input.name + ": " +
                               std::string(strategy.name) + " finds other contacts when it sees the start");
      expect_verified(start.total == 0, i);
      append_time("start", timed_.report.start_ms, result.rows[c].ms, repetition);
    }
  }
}

void Measurement::count_instructions(SectionResult& result) {
  const InstructionCounter counter;
  if (!counter.so_far()) return;
  for (std::size_t c = 0; c < setup_.contestants.size(); ++c) {
    const Contestant& contestant = setup_.contestants[c];
    if (contestant.threads > 1) continue;  // the counter sees one
    std::uint64_t sum = 0;
    for (const std::size_t i : result.section.timed) {
      const scenes::ClipInterval interval = lead_to(i, contestant.row, *contestant.timed);
      const std::uint64_t before = counter.so_far().value_or(0);
      contestant.timed->detect(setup_.input.step(interval), timed_.found);
      sum += counter.so_far().value_or(before) - before;
    }
    result.rows[c].footprint.instructions =
        static_cast<double>(sum) / static_cast<double>(result.section.timed.size());
  }
}

}  // namespace cscd::bench
