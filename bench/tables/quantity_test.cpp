#include "bench/tables/quantity.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

StrategyRecord row_of(const std::string& name, const std::string& guarantee, double ms) {
  StrategyRecord row;
  row.name = name;
  row.guarantee = guarantee;
  row.counts = {{"bvot", {10, 20, 60}}, {"negative", {1, 2, 3}}, {"uncertain", {4, 4, 4}}};
  // Two intervals in three repetitions; the second repetition was disturbed.
  row.ms = {{"refit", {{1, 3}, {10, 30}, {1, 3}}}, {"traversal", {{ms, ms}, {9 * ms, 9 * ms}, {ms, ms}}}};
  return row;
}

Record small_record() {
  Record record;
  record.scene = {"rope", "", "", 5, 6, 7, 4};
  record.verification.intervals = {0, 1, 2};
  record.verification.strategies = {{"slow", "complete", 8, 8, 2, {}},
                                    {"quick", "first_contact", 8, 6, 2, {}}};
  record.strategies = {row_of("slow", "complete", 10), row_of("slower", "complete", 20),
                       row_of("quick", "first_contact", 1), row_of("drvbc_fast_complete", "complete", 0.5),
                       row_of("slow --first", "complete", 0.1)};
  record.strategies[0].ms["streaming"] = {{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}};
  record.strategies[2].preparation = {{100, 300}, {20, 60}, 9};
  record.strategies[2].footprint.held_bytes = 4096;
  return record;
}

Measured of(const std::string& quantity, const std::string& strategy,
            ordered_json more = ordered_json::object()) {
  more["quantity"] = quantity;
  if (!strategy.empty()) more["strategy"] = strategy;
  return measure(more, small_record());
}

TEST(Quantity, ReadsWhatHasNoNoise) {
  EXPECT_EQ(of("scene.triangles", "").value, 6);
  EXPECT_EQ(of("scene.vertices", "").value, 5);
  EXPECT_EQ(of("scene.bones", "").value, 7);
  EXPECT_EQ(of("preparation.atomic_clusters", "quick").value, 9);
  EXPECT_EQ(of("footprint.held_bytes", "quick", {{"scale", 0.5}}).value, 2048);
  EXPECT_EQ(of("verification.recall", "quick").value, 0.75);
  EXPECT_EQ(of("verification.first_contacts", "quick").value, 2);
  EXPECT_FALSE(of("scene.triangles", "").interval);
}

TEST(Quantity, SumsCountersOverIntervals) {
  EXPECT_EQ(of("counts.bvot", "slow").value, 30);
  EXPECT_EQ(of("counts.bvot", "slow", {{"statistic", "median"}}).value, 20);
  EXPECT_EQ(of("counts.bvot", "slow", {{"statistic", "min"}}).value, 10);
  EXPECT_EQ(of("counts.bvot", "slow", {{"statistic", "max"}}).value, 60);
  EXPECT_EQ(of("counts.negative+uncertain", "slow").value, 6);
  EXPECT_FALSE(of("counts.bvot", "slow").interval);
}

// Mutation: the mean over the repetitions, which a disturbance moves.
TEST(Quantity, TakesTheMedianOverRepetitions) {
  EXPECT_EQ(of("ms.refit", "slow").value, 2);
  EXPECT_EQ(of("ms.refit+traversal", "slow").value, 12);
  EXPECT_EQ(of("ms.query", "slow").value, 12) << "stages that a row does not have take no time";
  EXPECT_EQ(of("ms.query", "slow", {{"statistic", "max"}}).value, 13);
  EXPECT_EQ(of("preparation.distance_and_heat_ms", "quick", {{"scale", 0.001}}).value, 0.2);
  const Measured total = of("ms.query", "slow");
  ASSERT_TRUE(total.interval);
  EXPECT_LE(total.interval->low, 12);
  EXPECT_EQ(total.interval->high, 110);
}

// Both halves of a ratio are of one repetition. Mutation: the ratio of two medians' ends as its interval.
TEST(Quantity, DividesWithinARepetition) {
  const Measured ratio = of("ms.traversal", "slow", {{"over", "quick"}});
  EXPECT_EQ(ratio.value, 10);
  ASSERT_TRUE(ratio.interval);
  EXPECT_EQ(ratio.interval->low, 10) << "the disturbance is in both";
  EXPECT_EQ(ratio.interval->high, 10);
  EXPECT_EQ(of("counts.bvot", "slow", {{"over", "quick"}}).value, 1);
  EXPECT_EQ(of("ms.query", "slow", {{"over_quantity", "ms.streaming"}}).value, 24);
  EXPECT_EQ(of("counts.bvot", "quick", {{"over_quantity", "preparation.atomic_clusters"}}).value, 30 / 9.0);
  EXPECT_EQ(
      measure_over({{"quantity", "counts.bvot"}, {"strategy", "slow"}}, small_record(), small_record()).value,
      1);
}

// Mutations: a row of the fast engine counts as a baseline; one that is asked for less does; the first one
// does.
TEST(Quantity, FindsTheBestBaseline) {
  const Measured least = of("ms.query", kBestBaseline);
  EXPECT_EQ(least.of, "slow");
  EXPECT_EQ(least.value, 12);
  const Measured over = of("ms.query", kBestBaseline, {{"over", "drvbc_fast_complete"}});
  EXPECT_EQ(over.of, "slow");
  EXPECT_EQ(over.value, 12 / 2.5);
  Record none = small_record();
  none.strategies.erase(none.strategies.begin(), none.strategies.begin() + 2);
  EXPECT_EQ(measure({{"quantity", "ms.query"}, {"strategy", kBestBaseline}}, none).reason,
            "no complete baseline was run");
}

TEST(Quantity, SaysWhyThereIsNoFigure) {
  EXPECT_EQ(of("counts.pctp", "slow").reason, "slow: does not count pctp");
  EXPECT_EQ(of("ms.elementary", "slow").reason, "slow: has no stage elementary");
  EXPECT_EQ(of("ms.embedding", "slow").reason, "slow: needs no test of the start");
  EXPECT_EQ(of("ms.query+embedding", "quick").reason,
            "this record does not have the time of the test of the start");
  EXPECT_EQ(of("counts.bvot", "base").reason, "base: not run in this record");
  EXPECT_EQ(of("counts.bvot", "nosuch").reason, "nosuch: not in this build");
  EXPECT_EQ(of("preparation.atomic_clusters", "slow").reason, "slow: has no clusters");
  EXPECT_EQ(of("preparation.decomposition_ms", "slow").reason, "slow: has no such preparation");
  EXPECT_EQ(of("truth.missed", "").reason, "not held against truth from outside");
  EXPECT_EQ(of("verification.recall", "slower").reason, "slower: not verified in this record");
  for (const char* wrong : {"mood", "scene.mood", "footprint.mood", "mood.ms"})
    EXPECT_THROW(of(wrong, "slow"), std::logic_error) << wrong;
  EXPECT_THROW(of("counts.bvot", "slow", {{"statistic", "mode"}}), std::logic_error);
  EXPECT_THROW(of("ms.query", "slow", {{"over_quantity", "counts.bvot"}}), std::logic_error);
}

// A time whose row found 6 of 8 contacts is not for the same work. Mutation: counters are marked as well.
TEST(Quantity, MarksTimesOfRowsThatAnswerLess) {
  EXPECT_TRUE(of("ms.query", "quick").marked);
  EXPECT_TRUE(of("ms.query", "slow", {{"over", "quick"}}).marked);
  EXPECT_FALSE(of("ms.query", "slow").marked);
  EXPECT_FALSE(of("counts.bvot", "quick").marked);
}

TEST(Quantity, HasOneText) {
  const Measured figure = {1234.5, Estimate{1234.5, 999.7, 20000}, "", true, "mcd"};
  EXPECT_EQ(text_of(figure, true), "1,234 [1,000, 20,000]*, `mcd`");
  EXPECT_EQ(text_of(figure, false), "1,234*, `mcd`");
  EXPECT_EQ(text_of({{}, {}, "not run"}, true), "");
}

}  // namespace
}  // namespace cscd::bench
