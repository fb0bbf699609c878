#include "bench/random_verification.h"

#include <optional>

#include "bench/catalogue.h"
#include "core/detect/embedding.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

// One random interval, ready for any strategy.
struct Subject {
  std::uint64_t seed;
  scenes::RandomInterval random;
  TriangleMesh mesh;
  std::optional<Rig> rig;

  explicit Subject(std::uint64_t seed_in)
      : seed(seed_in),
        random(scenes::make_random_interval(seed)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count, "random interval"),
        rig(scenes::rig_of(random.clip)) {}

  ContactSet run(const Strategy& strategy, const ElementaryTest& test) {
    const std::unique_ptr<Detector> detector =
        strategy.make({mesh, random.clip.frame(0).positions, rig ? &*rig : nullptr, test}).detector;
    const scenes::ClipInterval interval = random.clip.interval(0);
    ContactSet found;
    detector->detect(interval.motion, interval.bones ? &*interval.bones : nullptr, found);
    found.sort();
    return found;
  }
};

}  // namespace

RandomSummary verify_random(const RandomVerification& plan, std::span<const Strategy> strategies,
                            const std::function<void(std::size_t)>& progress) {
  const ElementaryTest &exact = elementary_test_named("exact"), &inexact = elementary_tests().front();
  const Strategy &oracle = all_pairs(), &stand_in = complete_reference();
  RandomSummary summary;
  for (std::size_t i = 0; i < plan.intervals; ++i) {
    Subject subject(plan.first_seed + i);
    const bool by_all_pairs = i % plan.brute_every == 0;
    const Strategy& judge = by_all_pairs ? oracle : stand_in;
    const ContactSet reference = subject.run(judge, exact);
    EmbeddingTest embedding(subject.mesh, subject.random.clip.frame(0).positions);
    const bool embedded = embedding.embedded(subject.random.clip.frame(0).positions);

    ++summary.intervals;
    summary.embedded += embedded;
    summary.contacts += reference.contacts.size();
    summary.with_contacts += !reference.contacts.empty();
    if (embedded && !reference.contacts.empty()) {
      ++summary.embedded_with_contacts;
      ++summary.embedded_hits_of[std::string(subject.random.family)];
    }
    summary.newton.add(compare_elementary(reference, subject.run(judge, inexact)));
    for (const Strategy& strategy : strategies) {
      if (&strategy == &oracle && !by_all_pairs) continue;
      const ContactSet answer = &strategy == &judge ? reference : subject.run(strategy, exact);
      const Verification verdict = verify(reference, answer, strategy.guarantee, embedded);
      summary.found_by[std::string(strategy.name)] += verdict.found_contacts;
      if (!verdict.ok)
        summary.failures.push_back(
            {subject.seed, std::string(subject.random.family), std::string(strategy.name), verdict.failure});
    }
    if (progress) progress(i + 1);
  }
  return summary;
}

std::string describe(const RandomSummary& summary) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  std::string text = count(summary.intervals) + " random intervals: " + count(summary.embedded) +
                     " with an embedded start, " + count(summary.with_contacts) + " with contacts, " +
                     count(summary.embedded_with_contacts) + " with both (";
  bool first = true;
  for (const auto& [family, hits] : summary.embedded_hits_of) {
    text += (first ? "" : ", ") + family + " " + count(hits);
    first = false;
  }
  text += "); " + count(summary.contacts) + " contacts in all\n";
  for (const auto& [strategy, found] : summary.found_by)
    text += "  " + strategy + ": reports " + count(found) + "\n";
  text += "  " + std::string(elementary_tests().front().name) +
          " on the same pairs: " + count(summary.newton.misses) + " misses, " +
          count(summary.newton.false_alarms) + " false alarms, " + count(summary.newton.undecided) +
          " undecided\n";
  text += "  " + count(summary.failures.size()) + " failures\n";
  return text;
}

std::string write_failure(const RandomFailure& failure, const std::filesystem::path& folder) {
  scenes::RandomInterval random = scenes::make_random_interval(failure.seed);
  const std::filesystem::path path =
      folder / ("failure-" + failure.strategy + "-" + std::to_string(failure.seed) + ".h5");
  scenes::PointCacheWriter writer(path, random.clip.header(), true);
  scenes::copy_frames(random.clip, writer);
  writer.finish();
  return failure.strategy + ", family " + failure.family + ", seed " + std::to_string(failure.seed) + ": " +
         failure.what + "; replay with cscd query " + path.string();
}

}  // namespace cscd::bench
