#include "bench/compare/comparison.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>

#include "bench/compare/settings.h"
#include "bench/compare/test_records.h"
#include "bench/output/json_text.h"
#include "bench/output/schema.h"
#include "core/base/error.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

using test::small_record;

Side one_side(Record record) {
  std::vector<Record> records;
  records.push_back(std::move(record));
  return side_of(std::move(records), "a test");
}

// What comes out where the new record is the old one after `change`.
Comparison after(const std::function<void(Record&)>& change, Lane lane = Lane::counters) {
  Record changed = small_record();
  change(changed);
  return compare(one_side(small_record()), one_side(std::move(changed)), lane);
}

void expect_lost(const Comparison& comparison, const std::string& text) {
  EXPECT_EQ(comparison.verdict(), ComparisonVerdict::less_true) << comparison_text(comparison);
  EXPECT_NE(comparison_text(comparison).find(text), std::string::npos) << comparison_text(comparison);
  EXPECT_EQ(schema_violation(comparison_json(comparison), "compare.schema.json"), "");
}

TEST(Comparison, OfEqualRecordsFindsNothing) {
  const Comparison same = after([](Record&) {});
  EXPECT_EQ(same.verdict(), ComparisonVerdict::nothing_worse) << comparison_text(same);
  EXPECT_TRUE(same.truth.empty());
  EXPECT_TRUE(same.counters.empty());
  EXPECT_EQ(same.compared_counts, 3u * 2 * 4);  // rows, costs and other counters, intervals
  EXPECT_EQ(exit_status(same.verdict()), ExitStatus::done);
}

// What was not compared is not called the same.
TEST(Comparison, OfOtherScenesComparesNothing) {
  Record other = small_record();
  other.scene.name = "foot";
  const Comparison none = compare(one_side(small_record()), one_side(other), Lane::all);
  EXPECT_EQ(exit_status(none.verdict()), ExitStatus::refused);
  const std::string text = comparison_text(none);
  EXPECT_EQ(
      text.find("verdict: not comparable: everything not compared: OLD and NEW have no scene in common\n"),
      0u)
      << text;
  EXPECT_NE(text.find("truth: not compared\ncounters: not compared\n"), std::string::npos) << text;
  EXPECT_EQ(text.find(": the same"), std::string::npos) << text;
  ASSERT_EQ(none.unjudged_times.size(), 6u);
  EXPECT_EQ(none.unjudged_times[0].scene, "hand") << "of OLD";
  EXPECT_TRUE(none.unjudged_times[0].before_ms && !none.unjudged_times[0].after_ms);
  EXPECT_EQ(schema_violation(comparison_json(none), "compare.schema.json"), "");
}

// Mutation: settings that make two scenes of one are not named.
TEST(Comparison, SaysInWhichSettingsOneSceneDiffers) {
  const auto said = [](const std::function<void(Record&)>& change) {
    Record one = small_record(), other = small_record();
    one.thickness = other.thickness = 0.25;
    one.scene.name = other.scene.name = "hand, thickness 0.5e";
    change(other);
    return comparison_text(compare(one_side(one), one_side(other), Lane::all));
  };
  const std::string start =
      "verdict: not comparable: everything not compared: OLD and NEW have no scene in common; they have hand "
      "with other settings: ";
  EXPECT_EQ(said([](Record& r) {
              r.thickness = 0.5, r.scene.name = "hand, thickness 1e";
            }).find(start + "--thickness is 0.5e (0.25) and 1e (0.5)\n"),
            0u);
  EXPECT_EQ(said([](Record& r) {
              r.pipeline = Pipeline::published;
            }).find(start + "--pipeline is today and published\n"),
            0u);
  EXPECT_EQ(said([](Record& r) {
              r.thickness = 0, r.scene.name = "hand";
            }).find(start + "--thickness is 0.5e (0.25) and left out\n"),
            0u);
  // The same length, in units.
  const std::string same = said([](Record& r) { r.scene.name = "hand, thickness 0.25"; });
  EXPECT_NE(same.find("nothing worse"), std::string::npos) << same;
  EXPECT_EQ(same.find("other settings"), std::string::npos) << same;
}

// Mutation: values are compared as they are written.
TEST(Comparison, TakesSettingsThatAreSpeltOtherwiseForEqual) {
  const auto settings = [](const std::vector<std::string>& words) {
    Record record = small_record();
    record.command.insert(record.command.end(), words.begin(), words.end());
    return settings_of(record);
  };
  EXPECT_EQ(settings({"--exclude-near-rest", "0.20e"}), settings({"--exclude-near-rest=2e-1e"}));
  EXPECT_EQ(settings({"--fps", "24"}), settings({"--fps", "24.0"}));
  EXPECT_EQ(settings({"--ignore", "hand:arm"}), settings({"--ignore", "arm:hand"}));
  EXPECT_EQ(settings({"--ignore", "hand:arm"}), settings({"--ignore", "hand:arm", "--ignore", "arm:hand"}));
  EXPECT_NE(settings({"--fps", "24"}), settings({"--fps", "24e"}));
  EXPECT_NE(settings({"--ignore", "a:b:c"}), settings({"--ignore", "c:b:a"})) << "which colon is meant?";
}

TEST(Comparison, ShowsTimesThatItCannotJudge) {
  Record slower = small_record();
  for (auto& repetition : slower.strategies[0].ms["traversal"])
    for (double& ms : repetition) ms *= 2;
  const Comparison one = compare(one_side(small_record()), one_side(slower), Lane::all);
  EXPECT_EQ(exit_status(one.verdict()), ExitStatus::refused);
  ASSERT_EQ(one.unjudged_times.size(), 3u);
  EXPECT_NEAR(*one.unjudged_times[0].after_ms / *one.unjudged_times[0].before_ms, 1.9,
              0.01);  // refit takes 1 of 10
  EXPECT_NE(comparison_text(one).find("\n  slow "), std::string::npos) << comparison_text(one);
  EXPECT_NE(comparison_text(one).find("\n  swift*"), std::string::npos) << "found 2 of 3 contacts";
}

// Of each kind of finding the gravest are shown, and the rest is there for who asks.
TEST(Comparison, FitsOnAScreen) {
  const auto many = [](Record& record) {
    for (int i = 0; i < 40; ++i) {
      record.strategies.push_back(record.strategies[0]);
      record.strategies.back().name = "row" + std::to_string(i);
    }
  };
  Record before = small_record(), changed = small_record();
  many(before), many(changed);
  for (std::size_t i = 0; i < changed.strategies.size(); ++i) changed.strategies[i].counts["bvot"][0] += i;
  const Comparison comparison = compare(one_side(before), one_side(changed), Lane::all);
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_LT(lines(comparison_text(comparison)), 32) << comparison_text(comparison);
  EXPECT_GT(lines(comparison_text(comparison, true)), 80);
  EXPECT_NE(comparison_text(comparison).find("hand, row39 "), std::string::npos) << "the largest change";
}

TEST(Comparison, FindsEveryLossOfTruth) {
  expect_lost(after([](Record& r) { r.strategies[0].digests[1] = "xx"; }),
              "other contacts on 1 interval (1)");
  expect_lost(after([](Record& r) { r.strategies[1].first_times[2] = 0.5000000000000001; }),
              "another first time on 1 interval (2)");
  expect_lost(after([](Record& r) { r.strategies[1].first_times[1].reset(); }), "another first time");
  expect_lost(after([](Record& r) { r.verification.strategies[1].failures = {"missing contact"}; }),
              "verification failed: missing contact");
  expect_lost(after([](Record& r) { r.verification.accuracy.misses = 2; }), "contacts missed 2, in OLD 1");
  expect_lost(after([](Record& r) { r.verification.accuracy.false_alarms = 1; }), "contacts invented 1");
  expect_lost(after([](Record& r) { r.verification.accuracy.largest_time_error = 2e-9; }), "error of a time");
  expect_lost(after([](Record& r) { r.verification.strategies[2].contacts_found = 1; }), "found 1 of 3");
  expect_lost(after([](Record& r) { r.strategies[0].guarantee = "heuristic"; }), "promises less");
  expect_lost(after([](Record& r) { r.verification.intervals.clear(); }), "verified no interval");
}

// Records without first times only tell whether there was any contact.
TEST(Comparison, FindsALostContactWithoutFirstTimes) {
  Record before = small_record();
  for (StrategyRecord& row : before.strategies) row.first_times.clear();
  Record changed = before;
  changed.strategies[1].counts["contacts"][2] = 0;
  changed.strategies[1].digests[2] = "e0";
  expect_lost(compare(one_side(before), one_side(changed), Lane::counters), "whether there is contact");
}

TEST(Comparison, AllowsWhatAGuaranteeAllows) {
  // A later contact may come or go where only the first one is promised.
  Comparison later = after([](Record& r) {
    r.strategies[1].digests[1] = "xx";
    r.verification.strategies[1].contacts_found = 1;
  });
  EXPECT_EQ(later.verdict(), ComparisonVerdict::nothing_worse) << comparison_text(later);
  EXPECT_EQ(later.truth.size(), 2u);
  // Nothing is promised where the start crosses itself.
  Record unembedded = small_record();
  unembedded.verification.unembedded = {2};
  Record changed = unembedded;
  changed.strategies[1].first_times[2] = 0.75;
  later = compare(one_side(unembedded), one_side(changed), Lane::counters);
  EXPECT_EQ(later.verdict(), ComparisonVerdict::nothing_worse) << comparison_text(later);
  EXPECT_EQ(later.truth.size(), 1u);
}

TEST(Comparison, JudgesCountersExactly) {
  const Comparison worse = after([](Record& r) { ++r.strategies[1].counts["bvot"][3]; });
  ASSERT_EQ(worse.counters.size(), 1u);
  EXPECT_EQ(worse.counters[0].change, Change::worse);
  EXPECT_EQ(worse.counters[0].after, 1001u);
  EXPECT_EQ(exit_status(worse.verdict()), ExitStatus::failed);
  const Comparison better = after([](Record& r) { --r.strategies[1].counts["bvot"][3]; });
  EXPECT_EQ(better.counters.at(0).change, Change::better);
  EXPECT_EQ(exit_status(better.verdict()), ExitStatus::done);
  const Comparison other = after([](Record& r) { ++r.strategies[1].counts["clusters"][3]; });
  EXPECT_EQ(other.counters.at(0).change, Change::different);
  EXPECT_EQ(exit_status(other.verdict()), ExitStatus::done);
}

TEST(Comparison, ComparesTheIntervalsThatBothHave) {
  const Comparison fewer = after([](Record& r) {
    r.counted_intervals = {1, 3};
    for (StrategyRecord& row : r.strategies) {
      row.digests = {row.digests[1], row.digests[3]};
      row.first_times = {row.first_times[1], row.first_times[3]};
      for (auto& [counter, column] : row.counts) column = {column[1], column[3]};
    }
    r.timed_intervals = {1, 3};
    ++r.strategies[0].counts["bvot"][0];
  });
  ASSERT_EQ(fewer.counters.size(), 1u);
  EXPECT_EQ(fewer.counters[0].intervals, 2u);
  EXPECT_EQ(fewer.counters[0].before, 600u);
}

TEST(Comparison, JudgesMemoryBeyondItsFloor) {
  const auto with_memory = [](std::uint64_t bytes) {
    Record record = small_record();
    record.strategies[0].footprint.peak_bytes = bytes;
    return one_side(record);
  };
  const Comparison noise = compare(with_memory(100 << 20), with_memory(102 << 20), Lane::counters);
  EXPECT_TRUE(noise.footprint.empty());
  const Comparison more = compare(with_memory(100 << 20), with_memory(110 << 20), Lane::counters);
  EXPECT_EQ(more.footprint.at(0).change, Change::worse);
  EXPECT_EQ(exit_status(more.verdict()), ExitStatus::failed);
}

TEST(Comparison, RefusesTimesOfOtherMachinesWithTheReason) {
  const Comparison other = after([](Record& r) { r.environment["cpu"] = "another machine"; }, Lane::all);
  ASSERT_EQ(other.refusals.size(), 1u);
  EXPECT_EQ(other.refusals[0].what, "times");
  EXPECT_EQ(other.refusals[0].reason, "other machines: cpu is a machine and another machine");
  EXPECT_EQ(exit_status(other.verdict()), ExitStatus::refused);
  // Truth and counters are compared all the same.
  EXPECT_EQ(exit_status(after(
                            [](Record& r) {
                              r.environment["cpu"] = "another machine";
                              r.strategies[0].digests[1] = "xx";
                            },
                            Lane::all)
                            .verdict()),
            ExitStatus::failed);
  EXPECT_EQ(exit_status(after([](Record& r) { r.environment["cpu"] = "another machine"; }).verdict()),
            ExitStatus::done);
}

TEST(Comparison, RefusesWhatCannotBeCompared) {
  const auto reasons = [](const Comparison& comparison) {
    std::string out;
    for (const Refusal& refusal : comparison.refusals) out += refusal.what + ": " + refusal.reason + "\n";
    return out;
  };
  EXPECT_NE(
      reasons(after([](Record& r) { r.scene.digest = "other"; }, Lane::all)).find("counters: the scene"),
      std::string::npos);
  EXPECT_NE(
      reasons(after([](Record& r) { r.elementary = "exact"; }, Lane::all)).find("times: other settings"),
      std::string::npos);
  EXPECT_NE(reasons(after([](Record&) {}, Lane::all)).find("times: the smaller side has 1 process"),
            std::string::npos);
  EXPECT_NE(reasons(after([](Record& r) {
              r.environment["instruction_set"] = "SSE2";
            })).find("counters: instruction sets"),
            std::string::npos);
  EXPECT_EQ(exit_status(after([](Record& r) { r.scene.name = "foot"; }).verdict()), ExitStatus::refused);
}

// A setting that changes what a run counts or answers, and how the reason names it.
struct OtherSetting {
  std::function<void(Record&)> change;
  std::string reason;
};

OtherSetting option(const std::vector<std::string>& words, const std::string& reason) {
  return {[words](Record& r) { r.command.insert(r.command.end(), words.begin(), words.end()); }, reason};
}

// The new record counts more and finds other contacts, as another question does. That is no fault of it.
TEST(Comparison, ComparesBetweenEqualSettingsOnly) {
  const OtherSetting settings[] = {
      {[](Record& r) { r.elementary = "exact"; }, "--elementary is newton and exact"},
      {[](Record& r) { r.thickness = 0.25; }, "--thickness is left out and 0.25"},
      {[](Record& r) { r.scene.triangles = 9; },
       "the surface is 4 vertices, 8 triangles, 1 bones and 4 vertices, 9 triangles, 1 bones"},
      option({"--ignore-neighbours", "1"}, "--ignore-neighbours is left out and 1"),
      option({"--ignore", "hand:arm", "--ignore", "arm:arm"}, "--ignore is left out and arm:arm arm:hand"),
      option({"--exclude-rings=3"}, "--exclude-rings is left out and 3"),
      option({"--flip-inward", "--seed", "1"}, "--flip-inward is left out and given"),
      option({"--an-option-to-come", "x"}, "--an-option-to-come is left out and x"),
  };
  for (const OtherSetting& setting : settings) {
    const Comparison other = after(
        [&](Record& r) {
          setting.change(r);
          for (StrategyRecord& row : r.strategies) ++row.counts["bvot"][3];
          r.strategies[0].digests[1] = "xx";
          r.strategies[0].footprint.peak_bytes = 1 << 30;
        },
        Lane::all);
    EXPECT_EQ(other.verdict(), ComparisonVerdict::not_comparable) << setting.reason;
    EXPECT_TRUE(other.counters.empty() && other.truth.empty() && other.times.empty()) << setting.reason;
    const std::string text = comparison_text(other);
    EXPECT_NE(
        text.find("\ntruth: not compared\ncounters: not compared\nmemory and instructions: not compared\n"),
        std::string::npos)
        << text;
    for (const char* what : {"digests of contacts", "counters", "times"})
      EXPECT_NE(text.find(std::string(what) + " not compared: other settings: " + setting.reason),
                std::string::npos)
          << text;
    // What is nevertheless wrong by its own record is still said.
    const Comparison failed = after([&](Record& r) {
      setting.change(r);
      r.verification.strategies[0].failures = {"missing contact"};
    });
    EXPECT_EQ(failed.verdict(), ComparisonVerdict::less_true) << setting.reason;
  }
}

TEST(Comparison, IsNotHinderedByOptionsThatChangeNoCounter) {
  const Comparison same = after([](Record& r) {
    r.command = {"cscd", "run", "--scene", "hand", "--threads", "2", "--repetitions=9", "--json", "new.json"};
    ++r.strategies[1].counts["bvot"][3];
  });
  EXPECT_TRUE(same.refusals.empty()) << comparison_text(same);
  EXPECT_EQ(same.counters.size(), 1u);
}

// The counters of a row that follows the surface depend on the intervals that were played to it before.
TEST(Comparison, LeavesOutTheCountersOfARowWithAnotherLead) {
  const Comparison led = after([](Record& r) {
    r.strategies[1].lead = 24;
    for (StrategyRecord& row : r.strategies) ++row.counts["bvot"][3];
  });
  ASSERT_EQ(led.counters.size(), 2u) << comparison_text(led);
  for (const CounterFinding& finding : led.counters) EXPECT_NE(finding.row, "swift");
  EXPECT_NE(comparison_text(led).find("swift was led up to each interval by 0 and 24 intervals"),
            std::string::npos)
      << comparison_text(led);
}

TEST(Comparison, RefusesRecordsOfTwoSettingsOnOneSide) {
  std::vector<Record> records = {small_record(), small_record()};
  records[1].elementary = "exact";
  EXPECT_THROW(side_of(std::move(records), "OLD"), InputError);
}

TEST(Comparison, RefusesRecordsOfTwoCommitsOnOneSide) {
  std::vector<Record> records = {small_record("aaaaaaaaaaaaaaaa"), small_record("bbbbbbbbbbbbbbbb")};
  EXPECT_THROW(side_of(std::move(records), "OLD"), InputError);
}

TEST(Comparison, FindsProcessesThatAnswerDifferently) {
  std::vector<Record> before = {small_record()}, changed = {small_record(), small_record()};
  changed[1].strategies[2].digests[1] = "xx";
  const Comparison comparison = compare(side_of(before, "OLD"), side_of(changed, "NEW"), Lane::counters);
  expect_lost(comparison, "processes of NEW answer differently");
}

// The new processes take `slower` times as long in the traversal of the row `slow`.
Comparison of_processes(std::size_t count, double slower, bool in_turns) {
  std::vector<Record> before, changed;
  for (std::size_t i = 0; i < count; ++i) {
    const int second = static_cast<int>(i);
    Record one = small_record("aaaaaaaaaaaaaaaa", in_turns ? 2 * second : second),
           other = small_record("bbbbbbbbbbbbbbbb", in_turns ? 2 * second + 1 : 30 + second);
    const double noise = 1 + 0.0002 * static_cast<double>(i % 3);
    for (Record* record : {&one, &other}) {
      record->strategies[0].ms["traversal"] = {{6, 12}, {6, 12}};
      for (auto& [stage, repetitions] : record->strategies[0].ms)
        for (auto& repetition : repetitions)
          for (double& ms : repetition) ms *= noise;
    }
    for (auto& repetition : other.strategies[0].ms["traversal"])
      for (double& ms : repetition) ms *= slower;
    before.push_back(std::move(one));
    changed.push_back(std::move(other));
  }
  return compare(side_of(before, "OLD"), side_of(changed, "NEW"), Lane::all);
}

TEST(Comparison, ReportsASlowerStage) {
  const Comparison slower = of_processes(9, 1.1, true);
  EXPECT_TRUE(slower.refusals.empty()) << comparison_text(slower);
  EXPECT_EQ(exit_status(slower.verdict()), ExitStatus::failed);
  for (const TimeFinding& time : slower.times)
    EXPECT_EQ(time.change, time.row == "slow" && (time.stage == "traversal" || time.stage == "total")
                               ? Change::worse
                               : Change::same)
        << time.row << " " << time.stage;
  ASSERT_EQ(slower.means.size(), 3u);
  EXPECT_NEAR(slower.means.at(0).ratio.value, 1 + 0.1 * 9 / 10, 1e-3);  // refit takes 1 of 10 and is the same
  EXPECT_EQ(schema_violation(comparison_json(slower), "compare.schema.json"), "");
  EXPECT_NE(comparison_markdown(slower).find("### Times that changed"), std::string::npos);
  EXPECT_EQ(exit_status(of_processes(9, 0.9, true).verdict()), ExitStatus::done);
}

TEST(Comparison, WithholdsWhatIsBelowTheFloor) {
  const Comparison little = of_processes(9, 1.01, true);
  EXPECT_EQ(exit_status(little.verdict()), ExitStatus::done);
  EXPECT_EQ(little.times.at(1).stage, "traversal");
  EXPECT_EQ(little.times.at(1).withheld, "below the floor");
}

TEST(Comparison, WithholdsWhatOnlySomeLayoutsShow) {
  std::vector<Record> before, changed;
  for (int i = 0; i < 12; ++i) {
    before.push_back(small_record("aaaaaaaaaaaaaaaa", 2 * i));
    changed.push_back(small_record("bbbbbbbbbbbbbbbb", 2 * i + 1));
    changed.back().environment["layout"] = std::to_string(i % 3);
    const double factor = i % 3 == 0 ? 0.99 : 1.1;
    for (auto& repetition : changed.back().strategies[0].ms["traversal"])
      for (double& ms : repetition) ms *= factor;
  }
  const Comparison comparison = compare(side_of(before, "OLD"), side_of(changed, "NEW"), Lane::all);
  EXPECT_EQ(exit_status(comparison.verdict()), ExitStatus::done) << comparison_text(comparison);
  EXPECT_EQ(comparison.times.at(1).pairings, 3u);
  EXPECT_EQ(comparison.times.at(1).agreeing, 2u);
}

TEST(Comparison, RefusesTimesThatWereNotMeasuredInTurns) {
  const Comparison after_each_other = of_processes(9, 1.1, false);
  EXPECT_EQ(exit_status(after_each_other.verdict()), ExitStatus::refused);
  EXPECT_NE(comparison_text(after_each_other).find("one side was measured after the other"),
            std::string::npos);
}

// The lost contact ends it with status 1 whatever the times say.
TEST(Comparison, PutsTruthBeforeTimes) {
  Record lost = small_record();
  lost.strategies[0].digests[1] = "xx";
  for (auto& [stage, repetitions] : lost.strategies[0].ms)
    for (auto& repetition : repetitions)
      for (double& ms : repetition) ms /= 2;
  const Comparison comparison = compare(one_side(small_record()), one_side(lost), Lane::all);
  EXPECT_EQ(comparison.verdict(), ComparisonVerdict::less_true);
}

TEST(Sides, AreReadFromFilesAndFolders) {
  const cscd::test::Folder folder;
  std::filesystem::create_directories(folder / "many");
  cscd::test::write(folder / "one.json", json_text(to_json(small_record())));
  cscd::test::write(folder / "many/a.json", json_text(to_json(small_record("aaaaaaaaaaaaaaaa", 1))));
  cscd::test::write(folder / "many/tables.json", R"({"schema": "cscd.tables/1"})");
  EXPECT_EQ(read_side((folder / "one.json").string()).scenes.at("hand").size(), 1u);
  const Side both = read_side((folder / "one.json").string() + "," + (folder / "many").string());
  EXPECT_EQ(both.scenes.at("hand").size(), 2u);
  EXPECT_EQ(both.scenes.at("hand")[0].strategies[1].first_times, small_record().strategies[1].first_times);
  EXPECT_THROW(read_side((folder / "none.json").string()), InputError);
  EXPECT_THROW(read_side((folder / "many/tables.json").string()), InputError);
  EXPECT_THROW(read_side(""), InputError);
  std::filesystem::create_directories(folder / "empty");
  EXPECT_THROW(read_side((folder / "empty").string()), InputError);
}

}  // namespace
}  // namespace cscd::bench
