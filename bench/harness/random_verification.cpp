#include "bench/harness/random_verification.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "bench/strategies/catalogue.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/geometry/feature_distance.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/mean_edge.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
// One interval in so many is followed by one of a torn surface, for the rows that promise to be complete.
constexpr std::size_t kTornEvery = 3;

template <class Query>
Answer put_off(const Query&) {
  return {Verdict::undecided, 0};
}
template <class Query>
void put_off_close(std::span<const Query>, std::span<const double>, const TestParameters&,
                   std::span<Answer> answers) {
  std::ranges::fill(answers, Answer{Verdict::undecided, 0});
}

// The elementary test while a strategy runs: every pair that gets past the certified filter is put off, so
// that the oracle answers it once, however many strategies pass it on. The filter is told in single
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
                                 kSinglePrecisionFirst,
                                 put_off_close<MovingVertexFace>,
                                 put_off_close<MovingEdgeEdge>};

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
  std::vector<double> of_vertex;          // of the thickness
  Thickness thickness;                    // 0 where no interval has one
  std::map<FeaturePair, Answer> answers;  // the oracle's

  Subject(std::uint64_t seed_in, bool torn_in, bool thick)
      : seed(seed_in),
        torn(torn_in),
        random(made(seed, torn)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count, "random interval"),
        rig(scenes::rig_of(random.clip)) {
    if (!thick) return;
    std::mt19937_64 random_bits(seed);
    const auto draw = [&] { return std::uniform_real_distribution<double>(0, 1)(random_bits); };
    const double least = least_distance_at_start(), some = std::exp2(-8 * draw());
    // Half of the starts are clear, for those who promise nothing of others.
    const double all =
        draw() < 0.5 && least > 0 ? some * least : some * mean_edge(mesh, random.clip.frame(0).positions);
    if (draw() < 0.7) {
      thickness = Thickness(all);
      return;
    }
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) of_vertex.push_back(all / 4 * draw());
    thickness = Thickness(all / 2, of_vertex);
  }
  Subject(const Subject&) = delete;

  double least_distance_at_start() const {
    const Motion motion = random.clip.interval(0).motion;
    double least = HUGE_VAL;
    for_each_pair([&](const FeaturePair& pair) {
      least = std::min(least,
                       pair.kind == FeaturePair::Kind::vertex_face
                           ? distance_at(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}), 0)
                           : distance_at(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}), 0));
    });
    return least;
  }
  template <class Take>
  void for_each_pair(const Take& take) const {
    const auto vertices = static_cast<std::int32_t>(mesh.vertex_count()),
               edges = static_cast<std::int32_t>(mesh.edge_count()),
               triangles = static_cast<std::int32_t>(mesh.triangle_count());
    for (std::int32_t v = 0; v < vertices; ++v)
      for (std::int32_t t = 0; t < triangles; ++t)
        if (!contains(mesh.corners(TriangleId{t}), VertexId{v}))
          take(FeaturePair::of(VertexId{v}, TriangleId{t}));
    for (std::int32_t e = 0; e < edges; ++e)
      for (std::int32_t f = e + 1; f < edges; ++f)
        if (!share_vertex(mesh.ends(EdgeId{e}), mesh.ends(EdgeId{f})))
          take(FeaturePair::of(EdgeId{e}, EdgeId{f}));
  }

  StrategyInput setup(const ElementaryTest& test, bool first_only = false) const {
    return {mesh, random.clip.frame(0).positions, rig ? &*rig : nullptr, test, 1, first_only};
  }
  struct Result {
    ContactSet passed_on, found;
    Report report;
    Crossings start;  // of a strategy that sees starts
  };
  Result run(const StrategyRow& row, const ElementaryTest& oracle) {
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
    Step step{.motion = interval.motion, .bones = bones, .thickness = thickness};
    if (row.strategy->sees_start) step.crossings = &result.start, step.most_crossings = kAll;
    result.report = detector->detect(step, result.passed_on);
    for (const Contact& contact : result.passed_on.contacts) {
      const auto [entry, fresh] = answers.try_emplace(contact.pair);
      if (fresh)
        entry->second =
            ask_close(oracle, mesh, interval.motion, contact.pair, thickness.of(mesh, contact.pair));
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
    return std::ranges::count_if(set.contacts, [&](const Contact& contact) {
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

void judge(Subject&& subject, bool by_all_pairs, std::span<const StrategyRow> rows, RandomSummary& summary) {
  const ElementaryTest &exact = elementary_test_named("exact"), &inexact = elementary_tests().front();
  const Strategy& oracle = all_pairs();
  const StrategyRow judge{by_all_pairs ? &oracle : &complete_reference()};
  const Subject::Result judged = subject.run(judge, exact);
  const ContactSet& reference = judged.found;
  const std::span<const Vec3> start = subject.random.clip.frame(0).positions;
  const bool thick = !subject.thickness.is_zero();
  // With a thickness, whether the start is clear too.
  const bool embedded = EmbeddingTest(subject.mesh, start).embedded(start) &&
                        !(thick && !reference.contacts.empty() && reference.contacts.front().time == 0);
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
    if (thick && !strategy.knows_distance) continue;
    // Rows of signs alone refuse pairs of different thickness.
    if (!subject.thickness.is_uniform() && strategy.guarantee == Guarantee::first_contact) continue;
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
    judge(Subject(seed, false, plan.thick), by_all_pairs, rows, summary);
    if (i % kTornEvery == 0) judge(Subject(seed, true, plan.thick), by_all_pairs, rows, summary);
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
