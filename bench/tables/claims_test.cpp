#include "bench/tables/claims.h"

#include <gtest/gtest.h>

#include "bench/output/data.h"

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
  EXPECT_EQ(judge_claims(a_over_b({{"most", 1}}), {}).at(0).verdict, ClaimVerdict::not_measured);
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

// Every claim that ships can be judged, and says what it measures or why it measures nothing.
TEST(Claims, ShippedOnesAreComplete) {
  Record record = record_of("rope", 1, 10);
  const ordered_json published = data_json("published.json");
  const ordered_json shipped = data_json("claims.json");
  for (const ordered_json& claim : shipped["claims"]) {
    EXPECT_NE(claim.contains("measure"), claim.contains("not_measured_because")) << claim["id"];
    const ordered_json scenes = claim.value("scenes", ordered_json::array());
    for (const ordered_json& scene : scenes) EXPECT_TRUE(published["scenes"].contains(scene)) << scene;
  }
  for (const ClaimResult& claim : judge_claims(std::vector{record}))
    EXPECT_EQ(claim.verdict, ClaimVerdict::not_measured) << claim.id;
}

}  // namespace
}  // namespace cscd::bench
