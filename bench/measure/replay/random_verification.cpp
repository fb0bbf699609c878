#include "bench/measure/replay/random_verification.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "bench/measure/strategies/catalogue.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

template <class Query>
Answer put_off(const Query&) {
  return {Verdict::undecided, 0};
}

// The elementary test while a strategy runs: every pair that gets past the certified filter is put off, so
// that the referee answers it once, however many strategies pass it on. The filter is told in single
// precision first for every other seed.
template <bool kSinglePrecisionFirst>
constexpr ElementaryTest kPutOff{"put off",
                                 "everything is undecided",
                                 false,
                                 false,
                                 one_by_one<put_off<MovingVertexFace>>,
                                 one_by_one<put_off<MovingEdgeEdge>>,
                                 {},
                                 "",
                                 kSinglePrecisionFirst};

scenes::RandomInterval made(std::uint64_t seed, bool torn) {
  return torn ? scenes::make_torn_interval(seed) : scenes::make_random_interval(seed);
}

// One random interval, ready for any strategy.
struct Subject {
  std::uint64_t seed;
  bool torn;
  scenes::RandomInterval random;
  TriangleMesh mesh;
  std::optional<Rig> rig;
  std::map<FeaturePair, Answer> answers;  // the referee's

  Subject(std::uint64_t seed_in, bool torn_in)
      : seed(seed_in),
        torn(torn_in),
        random(made(seed, torn)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count, "random interval"),
        rig(scenes::rig_of(random.clip)) {}

  StrategyInput setup(const ElementaryTest& test, bool first_only = false) const {
    return {mesh, random.clip.frame(0).positions, rig ? &*rig : nullptr, test, 1, first_only};
  }
  struct Result {
    ContactSet passed_on, found;
    Report report;
    Crossings start;  // of a strategy that sees starts
  };
  Result run(const StrategyRow& row, const ElementaryTest& referee) {
    const bool even = seed % 2 == 0;
    // The earliest contact is known by its time, which cannot be put off.
    const ElementaryTest& test = row.first ? elementary_test_named(even ? "exact" : "filtered_exact")
                                           : (even ? kPutOff<false> : kPutOff<true>);
    const std::unique_ptr<Detector> detector = row.strategy->make(setup(test, row.first)).detector;
    const scenes::ClipInterval interval = random.clip.interval(0);
    Result result;
    const Rig::Interval* const bones = interval.bones ? &*interval.bones : nullptr;
    // What follows the surface has to be right whatever it was asked before: here, after it has cut its
    // clusters for this interval, for the start at rest, or for both.
    if (row.strategy->kind == StrategyKind::adaptive)
      for (std::uint64_t k = 0; k < seed % 5; ++k)
        detector->detect(
            {k % 2 == 1 ? Motion(interval.motion.start(), interval.motion.start()) : interval.motion, bones},
            result.passed_on);
    Step step{interval.motion, bones};
    if (row.strategy->sees_start) step.crossings = &result.start, step.most_crossings = kAll;
    result.report = detector->detect(step, result.passed_on);
    for (const Contact& contact : result.passed_on.contacts) {
      const auto [entry, fresh] = answers.try_emplace(contact.pair);
      if (fresh) entry->second = ask(referee, mesh, interval.motion, contact.pair);
      if (entry->second.verdict != Verdict::apart)
        result.found.contacts.push_back({contact.pair, entry->second.verdict, entry->second.time});
    }
    result.found.sort();
    if (row.first) keep_first(result.found);
    return result;
  }
  ContactSet ask_all(const ElementaryTest& test, const ContactSet& pairs) const {
    const scenes::ClipInterval interval = random.clip.interval(0);
    ContactSet found;
    for (const Contact& contact : pairs.contacts) {
      const Answer answer = ask(test, mesh, interval.motion, contact.pair);
      if (answer.verdict != Verdict::apart)
        found.contacts.push_back({contact.pair, answer.verdict, answer.time});
    }
    return found;
  }
};

// How many of the reference's contacts of the earliest time the answer lacks.
std::size_t first_pairs_missing(const ContactSet& reference, const ContactSet& answer) {
  const auto attaining_first = [&](const ContactSet& set) {
    return std::count_if(set.contacts.begin(), set.contacts.end(), [&](const Contact& contact) {
      return contact.time == reference.contacts.front().time;
    });
  };
  return static_cast<std::size_t>(attaining_first(reference) - attaining_first(answer));
}

// Holds the test that decides starts to the plain one, on both poses of the interval. Returns what crosses at
// the start.
Crossings judge_start_test(const Subject& subject, RandomSummary& summary) {
  EmbeddingTest plain(subject.mesh, subject.random.clip.frame(0).positions);
  EmbeddingTest fast = make_embedding_test(subject.setup(elementary_test_named("exact")));
  Crossings start;
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const std::span<const Vec3> pose = subject.random.clip.frame(frame).positions;
    const Crossings expected = plain.find_all(pose, kAll), found = fast.find_all(pose, kAll);
    if (frame == 0) start = expected;
    ++summary.poses;
    summary.poses_crossing += expected.total > 0;
    summary.crossings += expected.total;
    if (found.pairs != expected.pairs)
      summary.failures.push_back(
          {subject.seed, subject.torn, std::string(subject.random.family), "start test",
           "frame " + std::to_string(frame) + ": finds " + std::to_string(found.total) + " of " +
               std::to_string(expected.total) + " pairs of triangles that cross"});
  }
  return start;
}

void judge(Subject subject, bool by_all_pairs, std::span<const StrategyRow> rows, RandomSummary& summary) {
  const ElementaryTest &exact = elementary_test_named("exact"), &inexact = elementary_tests().front();
  const Strategy& oracle = all_pairs();
  const StrategyRow judge{by_all_pairs ? &oracle : &complete_reference()};
  const Subject::Result judged = subject.run(judge, exact);
  const ContactSet& reference = judged.found;
  const std::span<const Vec3> start = subject.random.clip.frame(0).positions;
  const bool embedded = EmbeddingTest(subject.mesh, start).embedded(start);
  const bool at_stake = embedded && !subject.torn && !reference.contacts.empty();

  ++summary.intervals;
  summary.torn += subject.torn;
  summary.embedded += embedded;
  summary.contacts += reference.contacts.size();
  summary.with_contacts += !reference.contacts.empty();
  summary.embedded_with_contacts += at_stake;
  if (at_stake) ++summary.embedded_hits_of[std::string(subject.random.family)];
  summary.newton.add(compare_elementary(reference, subject.ask_all(inexact, judged.passed_on)));

  const Crossings crossings = judge_start_test(subject, summary);
  for (const StrategyRow& asked : rows) {
    const Strategy& strategy = *asked.strategy;
    if (strategy.name == oracle.name && !by_all_pairs) continue;
    if (subject.torn && strategy.guarantee != Guarantee::complete) continue;  // promises nothing there
    const Subject::Result own = asked == judge ? Subject::Result{} : subject.run(asked, exact);
    const Subject::Result& result = asked == judge ? judged : own;
    const Verification verdict = verify(reference, result.found, asked, embedded);
    RandomRow& row = summary.rows[asked.name()];
    ++row.intervals;
    row.contacts_expected += verdict.reference_contacts;
    row.contacts_found += verdict.found_contacts;
    row.triangle_pairs += result.report.cull.pctp;
    row.feature_pairs += result.report.pairs.feature_pairs;
    if (strategy.own_test) row.invented += result.passed_on.contacts.size() - result.found.contacts.size();
    if (at_stake) {
      const std::size_t missing = first_pairs_missing(reference, result.found);
      row.first_pairs_missing += missing;
      row.firsts_thinned += missing > 0;
      row.firsts_lost += missing == first_pairs_missing(reference, ContactSet{});
    }
    if (strategy.sees_start && result.start.pairs != crossings.pairs)
      summary.failures.push_back(
          {subject.seed, subject.torn, std::string(subject.random.family), asked.name(),
           "sees " + std::to_string(result.start.total) + " of " + std::to_string(crossings.total) +
               " pairs of triangles that cross at the start"});
    if (!verdict.ok)
      summary.failures.push_back(
          {subject.seed, subject.torn, std::string(subject.random.family), asked.name(), verdict.failure});
  }
}

}  // namespace

RandomSummary verify_random(const RandomVerification& plan, std::span<const StrategyRow> rows,
                            const std::function<void(std::size_t)>& progress) {
  RandomSummary summary;
  for (std::size_t i = 0; i < plan.intervals; ++i) {
    const std::uint64_t seed = plan.first_seed + i;
    const bool by_all_pairs = i % plan.brute_every == 0;
    judge(Subject(seed, false), by_all_pairs, rows, summary);
    if (i % plan.torn_every == 0) judge(Subject(seed, true), by_all_pairs, rows, summary);
    if (progress) progress(i + 1);
  }
  return summary;
}

std::string describe(const RandomSummary& summary) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  std::string text = count(summary.intervals) + " random intervals, " + count(summary.torn) +
                     " of them torn and backwards: " + count(summary.embedded) + " with an embedded start, " +
                     count(summary.with_contacts) + " with contacts, " +
                     count(summary.embedded_with_contacts) + " with both (";
  bool first = true;
  for (const auto& [family, hits] : summary.embedded_hits_of) {
    text += (first ? "" : ", ") + family + " " + count(hits);
    first = false;
  }
  text += "); " + count(summary.contacts) + " contacts in all\n  start test, " + count(summary.poses) +
          " poses: " + count(summary.poses_crossing) + " with crossings, " + count(summary.crossings) +
          " pairs of triangles that cross\n";
  for (const auto& [strategy, row] : summary.rows)
    text += "  " + strategy + ", " + count(row.intervals) + " intervals: passes on " +
            count(row.triangle_pairs) + " triangle pairs, " + count(row.feature_pairs) +
            " feature pairs; reports " + count(row.contacts_found) + " of " + count(row.contacts_expected) +
            " contacts; lacks " + count(row.first_pairs_missing) + " pairs of the earliest time in " +
            count(row.firsts_thinned) + " intervals, all of them in " + count(row.firsts_lost) +
            (row.invented > 0 ? "; invents " + count(row.invented) + " contacts" : "") + "\n";
  text += "  " + std::string(elementary_tests().front().name) +
          " on the same pairs: " + count(summary.newton.misses) + " misses, " +
          count(summary.newton.false_alarms) + " false alarms, " + count(summary.newton.undecided) +
          " undecided\n";
  text += "  " + count(summary.failures.size()) + " failures\n";
  return text;
}

std::string write_failure(const RandomFailure& failure, const std::filesystem::path& folder) {
  scenes::RandomInterval random = made(failure.seed, failure.torn);
  std::string strategy = failure.strategy;
  std::erase(strategy, ' ');
  const std::filesystem::path path = folder / ("failure-" + strategy + "-" + std::to_string(failure.seed) +
                                               (failure.torn ? "-torn" : "") + ".h5");
  scenes::PointCacheWriter writer(path, random.clip.header(), true);
  scenes::copy_frames(random.clip, writer);
  writer.finish();
  return failure.strategy + ", family " + failure.family + ", seed " + std::to_string(failure.seed) +
         (failure.torn ? ", torn: " : ": ") + failure.what + "; replay with cscd query " + path.string() +
         " --unproven --json out.json --strategy " + failure.strategy;
}

}  // namespace cscd::bench
