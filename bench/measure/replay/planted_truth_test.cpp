#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "bench/compare/truth.h"
#include "bench/measure/replay/timing.h"
#include "bench/measure/replay/verification.h"
#include "bench/measure/strategies/catalogue.h"
#include "bench/testing/saboteurs.h"
#include "scenes/random/random_interval.h"

// Strategies with one flaw each run through the harness, and their records are held against those of a sound
// twin. Wherever the flaw changes an answer, the comparison has to say that truth was lost, whether the
// interval was verified or only counted.
namespace cscd::bench {
namespace {

using test::Flaw;

Input planted_input(std::uint64_t seed) {
  auto clip = std::make_unique<scenes::Clip>(scenes::make_random_interval(seed).clip);
  TriangleMesh mesh(clip->header().triangles, clip->header().vertex_count, "random interval");
  const std::span<const Vec3> first = clip->frame(0).positions;
  std::vector<Vec3> reference(first.begin(), first.end());
  std::optional<Rig> rig = scenes::rig_of(*clip);
  return {"random", std::move(clip), std::move(mesh), std::move(reference), std::move(rig)};
}

// The row's detector, but for the last contact's time, which is one unit in the last place too late.
class LateDetector : public Detector {
 public:
  explicit LateDetector(const StrategyInput& setup) : inner_(test::make_plain<Flaw::none>(setup).detector) {}
  Report detect(const Step& step, ContactSet& out) override {
    const Report report = inner_->detect(step, out);
    out.sort();
    if (!out.contacts.empty()) out.contacts.back().time = std::nextafter(out.contacts.back().time, 2.0);
    return report;
  }

 private:
  std::unique_ptr<Detector> inner_;
};
Prepared make_late(const StrategyInput& setup) {
  return {std::make_unique<LateDetector>(setup), {}};
}

Record record_of(std::uint64_t seed, Prepared (*make)(const StrategyInput&), bool is_verified) {
  Input input = planted_input(seed);
  const ElementaryTest& exact = elementary_test_named("exact");
  const Strategy strategy{"row",           "for tests",         Guarantee::complete,
                          Needs::any_mesh, StrategyKind::fixed, make};
  const std::array rows = {StrategyRow{&strategy}};
  std::vector<Contestant> contestants = make_contestants(input, rows, exact, exact);
  Verifier verifier(input, contestants, exact, exact);
  const std::vector<std::size_t> all = {0};
  if (is_verified) verifier.judge(all);
  Record record;
  record.scene.name = "random";
  record.elementary = exact.name;
  record.counted_intervals = all;
  record.strategies.resize(1);
  record.strategies[0].name = strategy.name;
  record.strategies[0].guarantee = to_string(strategy.guarantee);
  warm_up(input, contestants, all, verifier, record.strategies);
  record.verification = verifier.record();
  return record;
}

// How often the flaw changed an answer in `seeds` random intervals; each of these has to be found.
int plants_found(Prepared (*flawed)(const StrategyInput&), std::uint64_t seeds) {
  int changed = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
    for (const bool is_verified : {true, false}) {
      const std::vector<Record> sound = {record_of(seed, test::make_plain<Flaw::none>, is_verified)},
                                spoilt = {record_of(seed, flawed, is_verified)};
      const bool differs = sound[0].strategies[0].digests != spoilt[0].strategies[0].digests;
      const std::vector<TruthFinding> findings = compare_truth(sound, spoilt);
      EXPECT_EQ(std::ranges::any_of(findings, [](const auto& f) { return f.is_lost; }), differs)
          << "seed " << seed << (is_verified ? ", verified" : ", counted");
      changed += differs;
    }
  testing::Test::RecordProperty("answers changed, all found", changed);
  return changed;
}

TEST(PlantedTruth, IsFoundWhereABoundIsOneUlpTooTight) {
  EXPECT_GT(plants_found(test::make_plain<Flaw::bounds_one_ulp_too_tight>, 120), 0);
}
TEST(PlantedTruth, IsFoundWhereAPairIsDropped) {
  EXPECT_GT(plants_found(test::make_plain<Flaw::last_leaf_skipped>, 60), 0);
}
TEST(PlantedTruth, IsFoundWhereAContactTimeHasChanged) {
  EXPECT_GT(plants_found(make_late, 60), 0);
}

}  // namespace
}  // namespace cscd::bench
