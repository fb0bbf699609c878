#include "bench/tables/studies_json.h"

#include <gtest/gtest.h>
#include <string>

namespace cscd::bench {
namespace {

using nlohmann::json;

json answers(int queries, int contacts, int lost, int invented, int undecided) {
  return {{"row", "newton"},         {"queries", queries},          {"contacts", contacts},
          {"false_negatives", lost}, {"false_positives", invented}, {"undecided_contacts", undecided},
          {"undecided_apart", 1}};
}

// Each class of queries takes as long as its median, and counts as often as it was timed. Mutations: the mean
// of medians; a workload in the sums of another group.
TEST(Studies, SumAccuracyOverWorkloads) {
  json first = answers(10, 4, 1, 0, 0), second = answers(30, 6, 2, 5, 2), open = answers(7, 7, 0, 0, 0),
       none = answers(0, 0, 0, 0, 0);
  first["ns"] = {{"far", {{"queries", 6}, {"median", 100}}}, {"contact", {{"queries", 4}, {"median", 200}}}};
  second["ns"] = {{"far", {{"queries", 30}, {"median", 50}}}};
  first["time_error"] = {{"p99", 0.1}, {"largest_early", 0.2}, {"largest_late", 0}};
  second["time_error"] = {{"p99", 0.05}, {"largest_early", 0.3}, {"largest_late", 0.01}};
  const json record = {{"workloads",
                        {{{"group", "hard"},
                          {"name", "cone"},
                          {"hardness", 0.0001},
                          {"stages", {{"filter", 7}, {"referee", 3}}},
                          {"rows", {first}}},
                         {{"group", "hard"},
                          {"name", "edge"},
                          {"stages", {{"filter", 20}, {"referee", 10}}},
                          {"rows", {second}}},
                         {{"group", "open"}, {"name", "set"}, {"rows", {open, none}}}}}};
  const json sums = accuracy_json(record), hard = sums.at("group hard").at("newton");
  EXPECT_EQ(hard.at("queries"), 40);
  EXPECT_EQ(hard.at("contacts"), 10);
  EXPECT_EQ(hard.at("lost"), 3);
  EXPECT_EQ(hard.at("invented"), 5);
  EXPECT_EQ(hard.at("undecided"), 4);
  EXPECT_EQ(hard.at("ns"), (6 * 100 + 4 * 200 + 30 * 50) / 40.0);
  EXPECT_EQ(hard.at("ns_far"), (6 * 100 + 30 * 50) / 36.0);
  EXPECT_EQ(hard.at("ns_contact"), 200);
  EXPECT_EQ(hard.at("early"), 0.3);
  EXPECT_EQ(hard.at("late"), 0.01);
  EXPECT_EQ(hard.at("p99"), 0.1);
  EXPECT_FALSE(hard.contains("distance"));
  EXPECT_FALSE(sums.at("group open").at("newton").contains("ns")) << "nothing was timed";
  EXPECT_EQ(sums.at("hardness 0.0001").at("newton").at("queries"), 10);
  EXPECT_EQ(sums.at("family edge").at("newton").at("queries"), 30);
  EXPECT_EQ(sums.at("sweep").at("newton").at("queries"), 47);
  EXPECT_EQ(sums.at("all").at("newton").at("queries"), 47);
  EXPECT_FALSE(sums.contains("family set"));
  EXPECT_EQ(sums.at("stages").at("group hard"), (json{{"filter", 27}, {"referee", 13}}));
  EXPECT_EQ(sums.at("stages").at("hard cone"), (json{{"filter", 7}, {"referee", 3}}));
}

json timed(const std::string& name, int intervals, double contacts) {
  return {
      {"name", name}, {"intervals", intervals}, {"counts", {{"contacts", contacts}}}, {"ms", {{"total", 2}}}};
}

json growth_of(json step, const char* schema, const std::string& study = "size") {
  step["starts"] = {0, 1, 2, 3};
  step["step"] = 1;
  json names = json::array();
  for (const char* name : {"base", "drvbc_fast_complete"})
    names.push_back({{"name", name}, {"guarantee", "complete"}});
  for (const char* name : {"drvbc", "drvbc --first"})
    names.push_back({{"name", name}, {"guarantee", "first_contact"}});
  names.push_back({{"name", "fcl"}, {"guarantee", "heuristic"}});
  return growth_json(
      {{"schema", schema},
       {"subjects",
        {{{"study", study},
          {"scene", "rope"},
          {"triangles", 100},
          {"strategies", names},
          {"steps", {step}}}}},
       {"fits",
        {{{"study", "size"},
          {"scene", "rope"},
          {"strategy", "base"},
          {"quantity", "total"},
          {"exponent", 1.1}},
         {{"study", "size"}, {"scene", "rope"}, {"strategy", "base"}, {"quantity", "bvot"}, {"exponent", 2}},
         {{"study", "size"},
          {"scene", "rope"},
          {"strategy", "drvbc"},
          {"quantity", "total"},
          {"exponent", nullptr}}}}});
}

// A record that does not say what its rows lack. Mutations: a row that is asked for the first contact is held
// against all of them; a complete row that answered fewer intervals judges.
TEST(Studies, FindWhatOlderRowsLack) {
  const json step = {{"embedded", 3},
                     {"colliding", 2},
                     {"strategies",
                      {timed("base", 4, 2.5), timed("drvbc_fast_complete", 2, 9), timed("drvbc", 4, 2),
                       timed("drvbc --first", 4, 0.5), timed("fcl", 4, 2.5)}}};
  const json growth = growth_of(step, "cscd.scale/1"), lacking = growth.at("shortfalls")[0][0];
  EXPECT_EQ(lacking.size(), 2u) << lacking;
  EXPECT_EQ(lacking.at("drvbc"), "kept 8 of 10 contacts; promise void on 1 of 4 intervals");
  EXPECT_EQ(lacking.at("drvbc --first"), "promise void on 1 of 4 intervals");
  ASSERT_EQ(growth.at("points").size(), 5u);
  EXPECT_EQ(growth.at("points")[2].at("size"), 100);
  EXPECT_EQ(growth.at("points")[2].at("marked"), true);
  EXPECT_EQ(growth.at("points")[4].at("marked"), false);
  ASSERT_EQ(growth.at("fits").size(), 1u) << "of times, where one was fitted";
  EXPECT_EQ(growth.at("fits")[0].at("exponent"), 1.1);
}

TEST(Studies, TakeFromARecordWhatItsRowsLack) {
  json said = timed("drvbc", 4, 2), not_timed = timed("fcl", 4, 0);
  said["shortfall"] = "kept 1 of 3 contacts";
  not_timed.erase("ms");
  json step = {{"embedded", 4}, {"clear", 0}, {"colliding", 2}, {"strategies", {said, not_timed}}};
  EXPECT_EQ(growth_of(step, "cscd.scale/2").at("shortfalls")[0][0],
            (json{{"drvbc", "kept 1 of 3 contacts"}}));
  EXPECT_EQ(growth_of(step, "cscd.scale/2", "contacts").at("points").size(), 0u) << "ratios at one size";
  step["strategies"] = {timed("base", 4, 2.5), timed("drvbc", 4, 2)};
  EXPECT_EQ(growth_of(step, "cscd.scale/2").at("shortfalls")[0][0], json::object())
      << "what is not said is not so";
}

}  // namespace
}  // namespace cscd::bench
