#include "bench/measure/shards/shards.h"

#include <nlohmann/json.hpp>

#include "bench/output/schema.h"
#include "bench/testing/test_shell.h"
#include "core/base/error.h"

// These tests divide a run as a user of a shell does: among workers, killed at any moment, and resumed.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

class Shards : public Program {
 protected:
  static constexpr char kCounts[] =
      "cscd run --scene small --strategy base,drvbc,drvbc_fast --counts --shard-intervals 1 ";
  static constexpr char kTimings[] =
      "cscd run --scene small --strategy base,drvbc,drvbc_fast --repetitions 2 --shard-intervals 1 ";

  // The record of all shards in a folder.
  Ran record(const std::string& shards, const std::string& name, const std::string& command = kCounts) const {
    return run(command + "--shards " + shards + " --json " + name);
  }
};

TEST_F(Shards, JoinToWhatOneRunCounts) {
  const Ran divided = record("shards", "shards.json");
  ASSERT_EQ(divided.status, 0) << divided.errors;
  EXPECT_NE(divided.out.find("shard 5 of 5, intervals 4 to 4: "), std::string::npos) << divided.out;
  ASSERT_EQ(
      run("cscd run --scene small --strategy base,drvbc,drvbc_fast --repetitions 1 --json run.json").status,
      0);
  const ordered_json one = ordered_json::parse(text("run.json")),
                     many = ordered_json::parse(text("shards.json"));
  for (const char* key : {"schema", "pipeline", "elementary", "seed", "intervals", "counted_intervals"})
    EXPECT_EQ(one.at(key), many.at(key)) << key;
  EXPECT_EQ(one.at("scene").at("digest"), many.at("scene").at("digest"));
  for (const char* key : {"ok", "reference", "intervals", "unembedded", "colliding", "disagreeing", "excused",
                          "strategies", "accuracy"})
    EXPECT_EQ(one.at("verification").at(key), many.at("verification").at(key)) << key;
  ASSERT_EQ(many.at("strategies").size(), 3u);
  for (std::size_t s = 0; s < 3; ++s)
    for (const char* key : {"name", "guarantee", "counts", "digests", "first_times"})
      EXPECT_EQ(one.at("strategies").at(s).at(key), many.at("strategies").at(s).at(key)) << key;
  for (const auto& [record, is_echoed] : {std::pair(&one, false), std::pair(&many, true)}) {
    const std::vector<std::string> words = record->at("command");
    EXPECT_EQ(std::ranges::count(words, "--counts") > 0, is_echoed);
  }
  EXPECT_EQ(schema_violation(many, "run.schema.json"), "");
  EXPECT_EQ(run("cscd tables shards.json").status, 0);
}

TEST_F(Shards, JoinToTheSameBytesInAnyOrderAndNumber) {
  ASSERT_EQ(record("one", "one.json").status, 0);
  const Ran workers = run("for i in 3 1; do " + std::string(kCounts) +
                          "--shards three --worker $i/3 || exit 1; done\n"
                          "for i in 1 2 3 4 5 6 7; do " +
                          kCounts + "--shards seven --worker $i/7 & done; wait");
  ASSERT_EQ(workers.status, 0) << workers.errors;
  EXPECT_NE(workers.out.find("worker 1/3 is done; 2 of 5 shards have no result yet"), std::string::npos)
      << workers.out;
  const Ran rest = record("three", "three.json");
  EXPECT_EQ(rest.status, 0) << rest.errors;
  EXPECT_NE(rest.out.find("shard 2 of 5, "), std::string::npos) << rest.out;
  EXPECT_EQ(rest.out.find("shard 1 of 5, "), std::string::npos)
      << "a result that was there was measured again";
  EXPECT_EQ(record("seven", "seven.json").out.find("shard "), std::string::npos);
  EXPECT_EQ(text("one.json"), text("three.json"));
  EXPECT_EQ(text("one.json"), text("seven.json"));
}

TEST_F(Shards, GoOnAfterWorkersAreKilled) {
  ASSERT_EQ(record("whole", "whole.json").status, 0);
  for (const std::string signal : {"KILL", "TERM", "INT"})
    for (const std::string delay : {"0.02", "0.08", "0.3"}) {
      const Ran ran =
          run("set -m; rm -rf shards again.json\nfor i in 1 2; do " + std::string(kCounts) +
              "--shards shards --worker $i/2 >/dev/null & done\nsleep " + delay + "\nkill -" + signal +
              " %1 %2 2>/dev/null; wait\n"
              "for file in shards/*.gz; do [ ! -e $file ] || gzip -t $file || exit 1; done\n" +
              kCounts + "--shards shards --json again.json >/dev/null && cmp again.json whole.json");
      EXPECT_EQ(ran.status, 0) << signal << " after " << delay << ": " << ran.errors;
    }
}

TEST_F(Shards, KeepTimesAndSayHowManyProcessesTookThem) {
  for (const std::string worker : {"1/2", "2/2"})
    ASSERT_EQ(run(std::string(kTimings) + "--shards shards --worker " + worker).status, 0);
  ASSERT_EQ(record("shards", "times.json", kTimings).status, 0);
  const ordered_json times = ordered_json::parse(text("times.json"));
  EXPECT_EQ(schema_violation(times, "run.schema.json"), "");
  EXPECT_EQ(times.at("processes"), 2);
  EXPECT_EQ(times.at("timed_intervals").size(), 5u);
  for (const ordered_json& strategy : times.at("strategies")) {
    ASSERT_EQ(strategy.at("ms").at("traversal").size(), 2u);
    for (const ordered_json& repetition : strategy.at("ms").at("traversal")) EXPECT_EQ(repetition.size(), 5u);
  }
  ASSERT_EQ(run("cscd tables times.json --out .").status, 0);
  EXPECT_NE(text("tables.md").find("| 2 by 2 processes |"), std::string::npos) << text("tables.md");
}

TEST_F(Shards, AreJoinedOnlyIfOneBuildOnOneMachineMeasuredThem) {
  ASSERT_EQ(record("kept", "times.json", kTimings).status, 0);
  for (const auto& [change, reason] :
       {std::pair("s/\"cpu\": \"/&other /", "differ in their environment (cpu: "),
        {"s/\"compiler\": \"/&other /", "differ in their environment (compiler: "},
        {"s/\"--seed\"/\"--seeds\"/", "its command or its intervals are not those of its shard"}}) {
    ASSERT_EQ(run("rm -rf shards; cp -r kept shards; file=$(ls shards/*.gz | tail -1); gzip -dc $file >+old\n"
                  "sed '" +
                  std::string(change) + "' +old >+new; cmp -s +old +new && exit 1; gzip -c +new >$file")
                  .status,
              0)
        << change << " changes nothing";
    expect_refused(record("shards", "none.json", kTimings), reason);
  }
}

// A result is found by what decides it, so what belongs to another input or another command is not found.
TEST_F(Shards, AreMeasuredAgainForAnotherInputOrCommand) {
  const auto measured = [&](const std::string& command) {
    const Ran ran = run(command + " --shards shards --worker 1/1");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return ran.out.find("shard 1 of ") != std::string::npos;
  };
  EXPECT_TRUE(measured(kCounts));
  EXPECT_FALSE(measured(kCounts));
  EXPECT_TRUE(measured(std::string(kCounts) + "--seed 7"));
  const std::string complete = "cscd run --scene small --strategy base --counts ";
  EXPECT_TRUE(measured(complete));
  EXPECT_TRUE(measured(complete + "--ignore-neighbours 1"));
  std::string scene = scenes::small_scene_with_digest();
  scene.replace(scene.find("\"rings\": 10"), 11, "\"rings\": 11");
  scene.replace(scene.find(", \"digest\""), 30, "");
  scene.replace(scene.find("\"vertices\": 82, \"triangles\": 160"), 32,
                "\"vertices\": 90, \"triangles\": 176");
  put("scenes/small.json", scene);
  EXPECT_TRUE(measured(kCounts));
}

TEST_F(Shards, NeedWhatTheyAreTold) {
  expect_refused(run("cscd run --scene small --worker 1/2"), "--shards");
  expect_refused(run("cscd run --scene small --shard-intervals 3 --json x.json"), "--shards");
  expect_refused(run("cscd run --scene small --shards shards"), "--json is required");
  expect_refused(run("cscd run --scene small --shards shards --worker 1/2 --json x.json"), "--json");
  expect_refused(run("cscd run --scene all --shards shards --worker 1/2"), "all");
  expect_refused(run("cscd run --scene small --shards scenes/small.json --worker 1/2"),
                 "folder scenes/small.json: ");
  EXPECT_EQ(parse_worker("2/3").number, 2u);
  EXPECT_EQ(parse_worker("2/3").count, 3u);
  for (const char* text :
       {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2x", "-1/2", "", "1//2", "99999999999999999999/2"})
    EXPECT_THROW(parse_worker(text), InputError) << text;
}

}  // namespace
}  // namespace cscd::bench
