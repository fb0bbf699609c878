#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "bench/compare/truth.h"
#include "bench/harness/test_trial.h"
#include "bench/strategies/catalogue.h"
#include "bench/testing/saboteurs.h"

// Strategies with one flaw each run through the harness, and their records are held against those of a sound
// twin. Wherever the flaw changes an answer, the comparison has to say that truth was lost, whether the
// interval was verified or only counted.
namespace cscd::bench {
namespace {

using test::Flaw;

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
  const ElementaryTest& exact = elementary_test_named("exact");
  const Strategy strategy{"row",           "for tests",         Guarantee::complete,
                          Needs::any_mesh, StrategyKind::fixed, make};
  const std::array rows = {StrategyRow{&strategy}};
  Trial trial(random_input(seed), rows, exact, exact);
  SectionResult& result = is_verified ? trial.verify() : trial.count();
  Record record;
  record.scene.name = "random";
  record.elementary = exact.name;
  record.counted_intervals = trial.all;
  record.strategies = std::move(result.rows);
  record.strategies[0].name = strategy.name;
  record.strategies[0].guarantee = to_string(strategy.guarantee);
  record.verification = result.verification;
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
