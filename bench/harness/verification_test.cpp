#include <array>
#include <gtest/gtest.h>
#include <vector>

#include "bench/harness/measurement.h"
#include "bench/harness/test_trial.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/detect/start/embedding.h"

// The harness is tested by strategies that cheat: each must be caught before it gets a time.
namespace cscd::bench {
namespace {

const ElementaryTest& exact_test() {
  return elementary_test_named("exact");
}
const ElementaryTest& newton() {
  return elementary_test_named("newton");
}

// Starts embedded, and has contacts at different times.
Input colliding_input() {
  for (std::uint64_t seed = 1; seed < 1000; ++seed) {
    Input input = random_input(seed);
    const scenes::ClipInterval interval = input.clip->load(0);
    if (!EmbeddingTest(input.mesh, input.reference).embedded(interval.motion.start())) continue;
    ContactSet found;
    complete_reference().make(input.setup(exact_test())).detector->detect({interval.motion}, found);
    found.sort();
    if (!found.contacts.empty() && found.contacts.front().time < found.contacts.back().time) return input;
  }
  throw std::logic_error("no random interval collides twice");
}

// Runs the reference and then spoils what it found.
using Spoil = void (*)(const StrategyInput& setup, int call, Report& report, ContactSet& found);
class Saboteur : public Detector {
 public:
  Saboteur(const StrategyInput& setup, Spoil spoil)
      : setup_(setup), honest_(complete_reference().make(setup).detector), spoil_(spoil) {}
  Report detect(const Step& step, ContactSet& out) override {
    Report report = honest_->detect(step, out);
    out.sort();
    spoil_(setup_, ++call_, report, out);
    return report;
  }

 private:
  StrategyInput setup_;
  std::unique_ptr<Detector> honest_;
  Spoil spoil_;
  int call_ = 0;
};

template <Spoil spoil>
Prepared sabotage(const StrategyInput& setup) {
  return {std::make_unique<Saboteur>(setup, spoil), {}};
}

void lose_first(const StrategyInput&, int, Report&, ContactSet& found) {
  const double first = found.contacts.front().time;
  std::erase_if(found.contacts, [&](const Contact& contact) { return contact.time == first; });
}
void lose_last(const StrategyInput&, int, Report&, ContactSet& found) {
  found.contacts.pop_back();
}
void invent(const StrategyInput&, int, Report&, ContactSet& found) {
  found.contacts.push_back({FeaturePair::of(VertexId{0}, TriangleId{0}), Verdict::contact, 0});
}
void cull_more_when_timed(const StrategyInput& setup, int, Report& report, ContactSet&) {
  report.cull.pctp -= setup.elementary.name != exact_test().name;
}
void forget_once(const StrategyInput& setup, int call, Report&, ContactSet& found) {
  if (setup.elementary.name != exact_test().name && call == 3) found.contacts.pop_back();
}
void count_otherwise_once(const StrategyInput& setup, int call, Report& report, ContactSet&) {
  *report.cull.bvot += setup.elementary.name != exact_test().name && call == 3;
}

SectionResult judge(const Strategy& strategy, std::size_t repetitions = 3) {
  const std::array rows = {StrategyRow{&complete_reference()}, StrategyRow{&strategy}};
  Trial trial(colliding_input(), rows, exact_test(), newton());
  SectionResult& result = trial.verify();
  trial.time(repetitions);
  return std::move(result);
}

std::vector<std::string> failures(Prepared (*make)(const StrategyInput&), Guarantee guarantee) {
  const SectionResult outcome =
      judge({"saboteur", "test", guarantee, Needs::any_mesh, StrategyKind::fixed, make});
  EXPECT_TRUE(outcome.verification.strategies[0].failures.empty());
  EXPECT_EQ(outcome.verification.ok(), outcome.verification.strategies[1].failures.empty());
  return outcome.verification.strategies[1].failures;
}

void lose_first_and_invent(const StrategyInput& setup, int call, Report& report, ContactSet& found) {
  lose_first(setup, call, report, found);
  invent(setup, call, report, found);
}

// A strategy with an elementary test of its own does not fail; what it gets wrong is listed.
TEST(Verification, OwnTestsAreComparedAndTimed) {
  const SectionResult outcome =
      judge({"checker", "test", Guarantee::heuristic, Needs::any_mesh, StrategyKind::fixed,
             sabotage<lose_first_and_invent>, "checker", true});
  EXPECT_TRUE(outcome.verification.ok());
  ASSERT_EQ(outcome.verification.own_tests.size(), 1u);
  const nlohmann::ordered_json& own = outcome.verification.own_tests[0];
  EXPECT_EQ(own["strategy"], "checker");
  EXPECT_GT(own["misses"], 0);
  EXPECT_EQ(own["false_alarms"], 1);
  ASSERT_EQ(own["differences"].size(), own["misses"].get<std::size_t>() + 1);
  EXPECT_TRUE(own["differences"].front()["said"].is_null());
  EXPECT_TRUE(own["differences"].front()["true"].is_number());
  EXPECT_EQ(own["differences"].front()["vertices"].size(), 4u);
  EXPECT_EQ(own["differences"].back()["said"], 0);
  EXPECT_TRUE(own["differences"].back()["true"].is_null());
  const VerifiedStrategy& row = outcome.verification.strategies[1];
  EXPECT_EQ(row.contacts_found + own["misses"].get<std::uint64_t>(), row.contacts_expected);
}

TEST(Verification, HonestStrategiesPassAndAreTimed) {
  for (const Strategy& strategy : strategies()) {
    const SectionResult outcome = judge(strategy);
    EXPECT_TRUE(outcome.verification.ok()) << strategy.name;
    EXPECT_EQ(outcome.verification.strategies[1].intervals_promised,
              strategy.guarantee == Guarantee::heuristic ? 0u : 1u)
        << strategy.name;
    EXPECT_EQ(outcome.verification.own_tests.size(), strategy.own_test ? 1u : 0u) << strategy.name;
    EXPECT_EQ(outcome.verification.colliding, std::vector<std::size_t>{0});
    EXPECT_TRUE(outcome.rows[1].ms.contains("streaming"));
    for (const auto& [stage, repetitions] : outcome.rows[1].ms) {
      ASSERT_EQ(repetitions.size(), 3u) << stage;
      for (const std::vector<double>& row : repetitions) EXPECT_EQ(row.size(), 1u) << stage;
    }
    EXPECT_EQ(outcome.rows[1].counts.at("pctp").size(), 1u);
    EXPECT_EQ(outcome.rows[1].digests.size(), 1u);
  }
}

TEST(Verification, LosingTheFirstContactFails) {
  EXPECT_EQ(failures(sabotage<lose_first>, Guarantee::complete).size(), 1u);
  EXPECT_EQ(failures(sabotage<lose_first>, Guarantee::first_contact).size(), 1u);
  EXPECT_TRUE(failures(sabotage<lose_first>, Guarantee::heuristic).empty());
}

TEST(Verification, LosingALaterContactFailsOnlyTheComplete) {
  EXPECT_EQ(failures(sabotage<lose_last>, Guarantee::complete).size(), 1u);
  EXPECT_TRUE(failures(sabotage<lose_last>, Guarantee::first_contact).empty());
}

TEST(Verification, ContactsThatTheReferenceLacksFail) {
  EXPECT_EQ(failures(sabotage<invent>, Guarantee::first_contact).size(), 1u);
}

TEST(Timing, CullingOtherwiseThanVerifiedVoidsTheTimes) {
  EXPECT_EQ(failures(sabotage<cull_more_when_timed>, Guarantee::complete),
            std::vector<std::string>{"interval 0: culls otherwise than when it was verified"});
}

TEST(Timing, AnswersThatDifferBetweenRepetitionsVoidTheTimes) {
  const std::vector<std::string> expected{
      "interval 0: other contacts or counters in repetition 1 than before"};
  EXPECT_EQ(failures(sabotage<forget_once>, Guarantee::complete), expected);
  EXPECT_EQ(failures(sabotage<count_otherwise_once>, Guarantee::complete), expected);
}

// Mutation: what the filter leaves for one test is held against what it leaves for another.
TEST(Verification, TheFilterMayLeaveOtherPairsForAnotherTest) {
  const ElementaryTest& filtered = elementary_test_named("filtered_exact");
  std::size_t others = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::array rows = {StrategyRow{&complete_reference()}};
    Trial trial(random_input(seed), rows, exact_test(), filtered);
    const SectionResult& result = trial.verify();
    EXPECT_TRUE(result.verification.ok()) << seed;
    Answered judged;
    const scenes::ClipInterval interval = trial.input.clip->load(0);
    ask(*trial.contestants[0].judged, rows[0], trial.input.step(interval), judged);
    others += result.counted[0][0]->report.pairs.elementary_tests != judged.report.pairs.elementary_tests;
  }
  EXPECT_GT(others, 0u);
}

// Mutation: rows are not compared, so only intervals that were chosen for it are verified.
TEST(Verification, AnIntervalOnWhichCompleteRowsDisagreeIsJudged) {
  for (const bool loses_first : {true, false}) {
    const Strategy saboteur{"saboteur",
                            "test",
                            loses_first ? Guarantee::first_contact : Guarantee::complete,
                            Needs::any_mesh,
                            StrategyKind::fixed,
                            loses_first ? sabotage<lose_first> : sabotage<lose_last>};
    const std::array rows = {StrategyRow{&complete_reference()}, StrategyRow{&saboteur}};
    Trial trial(colliding_input(), rows, exact_test(), exact_test());
    const VerificationRecord& verification = trial.count().verification;
    EXPECT_EQ(verification.disagreeing, trial.all);
    EXPECT_EQ(verification.intervals, trial.all);
    EXPECT_EQ(verification.strategies[1].failures.size(), 1u);
  }
}

// Contacts that a row is free to leave out are no disagreement.
TEST(Verification, ALaterContactThatARowNeedNotFindIsNoDisagreement) {
  const Strategy saboteur{
      "saboteur",         "test", Guarantee::first_contact, Needs::any_mesh, StrategyKind::fixed,
      sabotage<lose_last>};
  const std::array rows = {StrategyRow{&complete_reference()}, StrategyRow{&saboteur}};
  EXPECT_TRUE(
      Trial(colliding_input(), rows, exact_test(), exact_test()).count().verification.disagreeing.empty());
}

TEST(Timing, WhatWasNotAnsweredIsNotTimed) {
  const std::array rows = {StrategyRow{&complete_reference()}};
  Trial trial(colliding_input(), rows, exact_test(), newton());
  trial.measurement.count({{}, {}, trial.all});
  EXPECT_THROW(trial.time(3), InputError);
}

}  // namespace
}  // namespace cscd::bench
