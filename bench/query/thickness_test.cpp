#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/output/schema.h"
#include "bench/testing/test_queries.h"

// --thickness from outside: what query, view, inspect and run say with it.
namespace cscd::bench {
namespace {

using nlohmann::json;

class ThicknessOption : public QueryProgram {};

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(ThicknessOption, OfZeroChangesNothing) {
  const json plain = timeless(answer("figure.glb --clip hug"));
  EXPECT_FALSE(plain.contains("thickness"));
  EXPECT_EQ(plain, timeless(answer("figure.glb --clip hug --thickness 0")));
}

TEST_F(ThicknessOption, TellsWhatIsCloseFromWhatTouches) {
  const json plain = answer("figure.glb --clip hug"),
             thick = answer("figure.glb --clip hug --thickness 0.05e");
  EXPECT_EQ(thick["thickness"]["asked"], "0.05e");
  EXPECT_GT(thick["thickness"]["length"], 0);
  ASSERT_EQ(thick["intervals"].size(), plain["intervals"].size());
  std::size_t close = 0, at_start = 0;
  for (std::size_t i = 0; i < thick["intervals"].size(); ++i) {
    const json &one = thick["intervals"][i], &other = plain["intervals"][i];
    const std::string verdict = one["verdict"];
    close += verdict == "close";
    at_start += one["close_at_start"].get<std::size_t>();
    EXPECT_EQ(verdict == "close" ? "clear" : verdict, other["verdict"]) << i;
    EXPECT_EQ(one["touching"], other["contacts"].size()) << i;
    EXPECT_GE(one["contacts"].size(), other["contacts"].size()) << i;
    std::size_t touching = 0;
    for (const json& contact : one["contacts"]) {
      if (contact["touch_time"].is_null()) continue;
      ++touching;
      EXPECT_LE(contact["time"], contact["touch_time"]);
    }
    EXPECT_EQ(touching, other["contacts"].size()) << i;
  }
  EXPECT_EQ(thick["summary"]["close"], close);
  EXPECT_EQ(thick["summary"]["close_at_start"], at_start);
  EXPECT_EQ(run("cscd query small --thickness 0.05e --fail-on-contact").status,
            answer("small --thickness 0.05e")["summary"]["verdict"] == "clear" ? 0 : 3);
}

TEST_F(ThicknessOption, SaysHowManyPairsAreLeftOut) {
  const json document = answer("small --thickness 1e --exclude-rings 2");
  const json& left_out = document["thickness"]["left_out"];
  EXPECT_EQ(left_out["rings"], 2);
  EXPECT_EQ(document["strategy"], "drvbc_fast_complete");
  const Ran said = run("cscd query small --thickness 1e --exclude-near-rest 2e");
  EXPECT_EQ(said.status, 0) << said.errors;
  EXPECT_TRUE(says(said.out, "  thickness 1e (")) << said.out;
  EXPECT_TRUE(says(
      said.out, "; pairs of features that are near by construction are left out (--exclude-near-rest 2e ("))
      << said.out;
  EXPECT_TRUE(says(said.out, " others are this close at rest\n")) << said.out;
  const Ran inspected = run("cscd inspect small --thickness 1e --json inspect.json");
  EXPECT_EQ(inspected.status, 0) << inspected.errors;
  const json close = json::parse(text("inspect.json"))["thickness"];
  EXPECT_EQ(close["pairs_beyond_rings"][1], left_out["kept_at_rest"]);
  EXPECT_GT(close["pairs"], left_out["kept_at_rest"]);
}

TEST_F(ThicknessOption, IsVerifiedAndTimedByRun) {
  const Ran ran =
      run("cscd run --scene small --thickness 1e --strategy base,drvbc_fast,drvbc_fast_complete "
          "--elementary filtered_exact --repetitions 1 --json run.json");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.errors;
  const auto record = nlohmann::ordered_json::parse(text("run.json"));
  EXPECT_EQ(schema_violation(record, "run.schema.json"), "");
  EXPECT_GT(record["thickness"], 0);
  EXPECT_EQ(record["scene"]["name"], "small, thickness 1e");
  std::size_t contacts = 0;
  for (const auto& count : record["strategies"][0]["counts"]["contacts"])
    contacts += count.get<std::size_t>();
  EXPECT_GT(contacts, 0u) << "small touches nothing, and is this close to itself";
  const Ran tables = run("cscd tables run.json");
  EXPECT_EQ(tables.status, 0) << tables.errors;
}

TEST_F(ThicknessOption, RefusesInOneLine) {
  for (const char* command :
       {"query small", "view small", "run --scene small --json x.json", "inspect small"}) {
    const std::string start = std::string("cscd ") + command + " --thickness ";
    expect_refused(run(start + "-1"), "is negative");
    expect_refused(run(start + "nan"), "is not finite");
    expect_refused(run(start + "inf"), "is not finite");
    expect_refused(run(start + "e"), "is no length");
    expect_refused(run(start + "thick"), "is no length");
  }
  expect_refused(run("cscd query small --thickness 0.1 --strategy mcd"), "choose one of base, ");
  expect_refused(run("cscd view small --thickness 0.1 --strategy mcd"), "choose one of base, ");
  expect_refused(run("cscd query small --thickness 0.1 --elementary newton"), "knows no distances");
  expect_refused(run("cscd run --scene small --thickness 0.1 --json x.json"), "knows no distances");
  expect_refused(
      run("cscd run --scene small --thickness 0.1 --elementary exact --strategy mcd --json x.json"),
      "choose one of base, ");
  expect_refused(run("cscd query small --exclude-rings 1 --strategy drvbc_fast"), "cannot leave pairs out");
}

}  // namespace
}  // namespace cscd::bench
