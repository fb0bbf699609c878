#include "bench/tables/claims.h"

#include <gtest/gtest.h>

#include "bench/output/data.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

Record record_of(const std::string& scene, std::uint64_t a, std::uint64_t b) {
  Record record;
  record.scene.name = scene;
  StrategyRecord first, second;
  first.name = "a";
  first.counts = {{"bvot", {a}}};
  second.name = "b";
  second.counts = {{"bvot", {b}}};
  record.strategies = {first, second};
  return record;
}

ordered_json a_over_b(const ordered_json& expect) {
  return {
      {"claims",
       {{{"id", "c"},
         {"quote", "q"},
         {"where", "7.1"},
         {"scenes", {"rope", "hand", "man"}},
         {"measure", {{{"title", "a / b"}, {"quantity", "counts.bvot"}, {"strategy", "a"}, {"over", "b"}}}},
         {"expect", expect}}}}};
}

const std::vector<Record> kRecords = {record_of("rope", 1, 10), record_of("hand", 5, 10)};

TEST(Claims, AreReproducedWhereEveryMeasuredFigureHolds) {
  const ClaimResult claim = judge_claims(a_over_b({{"most", 0.5}}), kRecords).at(0);
  EXPECT_EQ(claim.verdict, ClaimVerdict::reproduced);
  EXPECT_EQ(claim.expectation, "at most 0.5");
  ASSERT_EQ(claim.evidence.size(), 2u);  // no record of man was given
  EXPECT_EQ(claim.evidence[1].measured.value, 0.5);
}

TEST(Claims, ArePartlyReproducedWhereSomeFiguresHold) {
  EXPECT_EQ(judge_claims(a_over_b({{"most", 0.4}}), kRecords).at(0).verdict, ClaimVerdict::partly);
  ordered_json somewhere = a_over_b({{"least", 0.4}});
  somewhere["claims"][0]["somewhere"] = true;
  EXPECT_EQ(judge_claims(somewhere, kRecords).at(0).verdict, ClaimVerdict::reproduced);
  EXPECT_EQ(judge_claims(a_over_b({{"least", 0.2}, {"most", 0.4}}), kRecords).at(0).verdict,
            ClaimVerdict::not_reproduced);
}

TEST(Claims, WithoutFiguresAreNotMeasured) {
  const ClaimResult unrecorded = judge_claims(a_over_b({{"most", 1}}), {}).at(0);
  EXPECT_EQ(unrecorded.verdict, ClaimVerdict::not_measured);
  EXPECT_NE(unrecorded.not_measured_because.find("rope, hand, man"), std::string::npos);
  ordered_json other = a_over_b({{"most", 1}});
  other["claims"][0]["measure"][0]["over"] = "nowhere";
  const ClaimResult claim = judge_claims(other, kRecords).at(0);
  EXPECT_EQ(claim.verdict, ClaimVerdict::not_measured);
  EXPECT_EQ(claim.evidence.at(0).measured.reason, "nowhere: not in this build");
}

// Mutation: a claim that is measured prints a reason that was written for another record.
TEST(Claims, ThatCannotBeMeasuredSayWhy) {
  const ordered_json claims = {
      {"claims", {{{"id", "c"}, {"quote", "q"}, {"where", "7.1"}, {"not_measured_because", "of noise"}}}}};
  const ClaimResult claim = judge_claims(claims, kRecords).at(0);
  EXPECT_EQ(claim.verdict, ClaimVerdict::not_measured);
  EXPECT_NE(claims_markdown(std::vector{claim}).find("of noise"), std::string::npos);
}

// Mutation: a claim is held against the wrong pipeline, or the other one decides, too.
TEST(Claims, AreHeldAgainstThePublishedPipelineWhereThereIsOne) {
  std::vector<Record> both = {record_of("rope", 1, 10), record_of("rope", 9, 10), record_of("hand", 1, 10)};
  both[1].pipeline = Pipeline::published;
  const ClaimResult claim = judge_claims(a_over_b({{"most", 0.5}}), both).at(0);
  EXPECT_EQ(claim.held_against, Pipeline::published);
  EXPECT_EQ(claim.verdict, ClaimVerdict::not_reproduced);
  ASSERT_EQ(claim.evidence.size(), 2u);
  EXPECT_EQ(claim.evidence[0].measured.value, 0.9);
  EXPECT_EQ(claim.evidence[0].today.value().value, 0.1);
  EXPECT_FALSE(claim.evidence[1].measured.value) << "hand has no record of that pipeline";
  std::vector<Record> hand_without_today = both;
  hand_without_today[2].pipeline = Pipeline::published;
  const ClaimResult lacks_today = judge_claims(a_over_b({{"most", 0.5}}), hand_without_today).at(0);
  EXPECT_NE(claims_markdown(std::vector{lacks_today}).find("0.1 | no record in the pipeline today |"),
            std::string::npos);
  const std::string page = claims_markdown(std::vector{claim});
  EXPECT_NE(page.find("a / b, published | **0.9**"), std::string::npos) << page;
  EXPECT_NE(page.find("a / b, today | 0.1"), std::string::npos) << page;
}

TEST(Claims, CompareThePipelinesWhereTheySaySo) {
  ordered_json claims = a_over_b({{"most", 0.5}});
  claims["claims"][0]["measure"] = {{{"title", "a, today against published"},
                                     {"quantity", "counts.bvot"},
                                     {"strategy", "a"},
                                     {"pipeline", "today"},
                                     {"over_pipeline", "published"}}};
  std::vector<Record> both = {record_of("rope", 1, 10), record_of("rope", 4, 10)};
  EXPECT_EQ(judge_claims(claims, std::span(both).first(1)).at(0).verdict, ClaimVerdict::not_measured);
  both[1].pipeline = Pipeline::published;
  EXPECT_EQ(judge_claims(claims, both).at(0).evidence.at(0).measured.value, 0.25);
}

// A claim about times that is missed shows where the time goes, beside the paper's.
TEST(Claims, ThatAreMissedShowTheStages) {
  ordered_json claims = a_over_b({{"least", 9}});
  claims["claims"][0]["measure"][0]["quantity"] = "ms.traversal";
  claims["stages"] = {{{"title", "traversal (ms)"},
                       {"quantity", "ms.traversal"},
                       {"published", {{"table3.{scene}.rvbc.bvh_traversal"}}}}};
  Record record = record_of("rope", 1, 10);
  for (StrategyRecord& row : record.strategies) row.ms = {{"traversal", {{2}, {2}}}};
  const ClaimResult claim = judge_claims(claims, std::vector{record}).at(0);
  ASSERT_EQ(claim.stages.size(), 2u);
  EXPECT_EQ(claim.stages[0].title, "a: traversal (ms)");
  EXPECT_EQ(claim.stages[0].today.value().value, 2);
  EXPECT_EQ(claim.stages[0].paper, 11.0);
  EXPECT_NE(claims_markdown(std::vector{claim}).find("a: traversal (ms) | –, 2 (11)"), std::string::npos);
}

// The paper gives one refit for the methods with 16-DOPs. Mutation: `aabb` is shown beside that figure.
TEST(Claims, HoldNoMethodAgainstTheFigureOfAnother) {
  ordered_json claims = a_over_b({{"least", 9}});
  claims["claims"][0]["measure"][0]["quantity"] = "ms.refit";
  claims["stages"] = {{{"title", "refit (ms)"},
                       {"quantity", "ms.refit"},
                       {"published", {{"text.refit_ms.{scene}"}}},
                       {"published_not_of", {"b"}}}};
  Record record = record_of("rope", 1, 10);
  for (StrategyRecord& row : record.strategies) row.ms = {{"refit", {{2}, {2}}}};
  const ClaimResult claim = judge_claims(claims, std::vector{record}).at(0);
  ASSERT_EQ(claim.stages.size(), 2u);
  EXPECT_EQ(claim.stages[0].paper, 20.0);
  EXPECT_EQ(claim.stages[1].paper, std::nullopt);
}

// Every claim that ships can be judged, and says what it measures or why it measures nothing. A bound is 1
// ("fewest"), or a number of the quote, or one of the readings that the comment in claims.json gives.
TEST(Claims, ShippedOnesAreComplete) {
  Record record = record_of("rope", 1, 10);
  const ordered_json published = data_json("published.json");
  const ordered_json shipped = data_json("claims.json");
  for (const ordered_json& claim : shipped["claims"]) {
    EXPECT_NE(claim.contains("measure"), claim.contains("not_measured_because")) << claim["id"];
    const std::string source = claim["quote"].get<std::string>() + shipped["comment"].get<std::string>();
    const ordered_json expect = claim.value("expect", ordered_json::object());
    for (const auto& [side, bound] : expect.items())
      EXPECT_TRUE(bound == 1 || source.find(exact_text(bound)) != std::string::npos) << claim["id"] << side;
    const ordered_json scenes = claim.value("scenes", ordered_json::array());
    for (const ordered_json& scene : scenes) EXPECT_TRUE(published["scenes"].contains(scene)) << scene;
  }
  for (const ClaimResult& claim : judge_claims(std::vector{record}))
    EXPECT_EQ(claim.verdict, ClaimVerdict::not_measured) << claim.id;
}

// Mutation: the ratio stands without the mark that its times have.
TEST(Claims, MarkRatiosOfTimesThatAreNotForTheSameWork) {
  ClaimResult claim;
  claim.evidence = {{"rope", "times faster", {1.5, {}, "", true}, true}};
  const std::string page = claims_markdown(std::vector{claim});
  EXPECT_NE(page.find("| 1.5* |"), std::string::npos) << page;
  EXPECT_NE(page.find(std::string("\n\\") + kShortfallMeaning), std::string::npos) << page;
  EXPECT_EQ(claims_json(std::vector{claim})[0]["evidence"][0]["text"], "1.5*");
  claim.evidence[0].measured.marked = false;
  EXPECT_EQ(claims_markdown(std::vector{claim}).find(kShortfallMeaning), std::string::npos);
}

}  // namespace
}  // namespace cscd::bench
