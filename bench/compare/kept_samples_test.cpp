#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <random>

#include "bench/compare/comparison.h"
#include "bench/compare/times.h"
#include "bench/output/gzip.h"
#include "scenes/catalog/scene.h"

// What the comparison finds on kept samples (kept_samples.json.gz): 162 processes of one program in six
// layouts (scripts/lib/layouts.py), run in turns on a machine of two cores with a load of five to nine. In a
// round each layout ran once, in a random order, with the options of scripts/compare-commits but eleven
// repetitions, on the scene hand.
// CSCD_COMPARE_SAMPLES names another such file, which scripts/record samples makes.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kPairs = 60;  // as scripts/compare-commits runs them unless told otherwise

class KeptSamples {
 public:
  KeptSamples() {
    const char* named = std::getenv("CSCD_COMPARE_SAMPLES");
    const std::filesystem::path file =
        named ? named : scenes::scenes_folder().parent_path() / "bench/compare/kept_samples.json.gz";
    std::ifstream stream(file, std::ios::binary);
    const std::string packed{std::istreambuf_iterator<char>(stream), {}};
    const ordered_json document = ordered_json::parse(without_gzip(packed, file.string(), 1u << 26));
    contacts = record_from(document.at("contacts"), file.string());
    const Record common = record_from(document.at("record"), file.string());
    for (const ordered_json& process : document.at("processes")) {
      Record record = common;
      const std::string layout = process.at("layout");
      record.environment["layout"] = layout;
      for (StrategyRecord& row : record.strategies) row.ms = process.at("ms").at(row.name).get<TimeColumns>();
      by_layout[layout].push_back(std::move(record));
    }
    rounds = by_layout.begin()->second.size();
  }

  Record contacts;                                       // of a scene in which contacts happen
  std::map<std::string, std::vector<Record>> by_layout;  // [layout][round]
  std::size_t rounds = 0;
};

const KeptSamples& kept() {
  static const KeptSamples samples;
  return samples;
}

std::string date(std::size_t second) {
  const auto two_digits = [](std::size_t n) { return (n < 10 ? "0" : "") + std::to_string(n); };
  return "2026-11-25T12:" + two_digits(second / 60) + ":" + two_digits(second % 60) + "Z";
}

// Compares three of the layouts with the three others, each layout with one of the other side, in rounds that
// are drawn without repetition. `change` spoils the new side.
Comparison drawn(std::mt19937_64& random, const std::function<void(Record&)>& change) {
  std::vector<std::string> layouts;
  for (const auto& [layout, records] : kept().by_layout) layouts.push_back(layout);
  std::shuffle(layouts.begin(), layouts.end(), random);
  const std::size_t pairings = layouts.size() / 2;
  std::vector<Record> before, after;
  for (std::size_t p = 0; p < pairings; ++p) {
    std::vector<std::size_t> rounds(kept().rounds);
    for (std::size_t r = 0; r < rounds.size(); ++r) rounds[r] = r;
    std::shuffle(rounds.begin(), rounds.end(), random);
    for (std::size_t k = 0; k < kPairs / pairings; ++k) {
      before.push_back(kept().by_layout.at(layouts[p])[rounds[k]]);
      after.push_back(kept().by_layout.at(layouts[pairings + p])[rounds[k]]);
      before.back().environment["date"] = date(2 * before.size());
      after.back().environment["date"] = date(2 * before.size() + 1);
      change(after.back());
    }
  }
  return compare(side_of(std::move(before), "OLD"), side_of(std::move(after), "NEW"), Lane::all);
}

// The same program against itself: nothing may be reported, of any row and stage.
TEST(KeptSamples, GiveNoFalseReportIn200Comparisons) {
  std::mt19937_64 random(34);
  int false_reports = 0;
  double smallest = 1e9, largest = 0;  // detectable changes of a whole query
  for (int i = 0; i < 200; ++i) {
    const Comparison comparison = drawn(random, [](Record&) {});
    EXPECT_EQ(comparison.verdict(), ComparisonVerdict::nothing_worse) << comparison_text(comparison);
    for (const TimeFinding& time : comparison.times) {
      EXPECT_EQ(time.change, Change::same) << comparison_text(comparison);
      if (time.stage != kTotal) continue;
      smallest = std::min(smallest, time.smallest_detectable);
      largest = std::max(largest, time.smallest_detectable);
    }
    ASSERT_GE(comparison.times.size(), 8u);
    false_reports += comparison.verdict() != ComparisonVerdict::nothing_worse;
  }
  std::printf("%d of 200 comparisons report a change; detectable of a whole query: %.3g to %.3g %%\n",
              false_reports, 100 * smallest, 100 * largest);
}

// How often of a hundred a stage that takes `factor` times as long is reported.
int found(const std::string& row, const std::string& stage, double factor) {
  std::mt19937_64 random(35);
  int count = 0;
  for (int i = 0; i < 100; ++i) {
    const Comparison comparison = drawn(random, [&](Record& record) {
      for (StrategyRecord& strategy : record.strategies)
        if (strategy.name == row)
          for (auto& repetition : strategy.ms.at(stage))
            for (double& ms : repetition) ms *= factor;
    });
    count += std::ranges::any_of(comparison.times, [&](const TimeFinding& time) {
      return time.row == row && time.stage == stage && time.change == Change::worse;
    });
  }
  testing::Test::RecordProperty("found of 100", count);
  std::printf("%s %s slower by %.3g %%: found in %d of 100\n", row.c_str(), stage.c_str(), 100 * (factor - 1),
              count);
  return count;
}

TEST(KeptSamples, ShowAStageThatIsFivePercentSlower) {
  EXPECT_GE(found("drvbc_fast_complete", "traversal", 1.05), 95);
}
TEST(KeptSamples, ShowAStageThatIsThreePercentSlower) {
  EXPECT_GE(found("drvbc_fast_complete", "traversal", 1.03), 80);
}

// Every loss of truth that the record of a scene with contacts can show, one at a time.
TEST(KeptSamples, ShowEveryPlantedLossOfTruth) {
  const auto planted = [](const std::function<void(Record&)>& change) {
    Record changed = kept().contacts;
    change(changed);
    std::vector<Record> before = {kept().contacts}, after = {changed};
    return compare(side_of(std::move(before), "OLD"), side_of(std::move(after), "NEW"), Lane::all).verdict();
  };
  EXPECT_EQ(planted([](Record&) {}), ComparisonVerdict::not_comparable) << "of one process the times";
  int plants = 0;
  const Record& record = kept().contacts;
  for (std::size_t s = 0; s < record.strategies.size(); ++s)
    for (std::size_t i = 0; i < record.counted_intervals.size(); ++i) {
      const StrategyRecord& row = record.strategies[s];
      if (!row.first_times[i]) continue;
      // A contact time that is off by one unit in the last place.
      EXPECT_EQ(planted([&](Record& r) {
                  StrategyRecord& changed = r.strategies[s];
                  changed.first_times[i] = std::nextafter(*changed.first_times[i], 2.0);
                  changed.digests[i] = "another";
                }),
                ComparisonVerdict::less_true);
      // All contacts of an interval lost, as by a bound that is too tight.
      EXPECT_EQ(planted([&](Record& r) {
                  r.strategies[s].first_times[i].reset();
                  r.strategies[s].digests[i] = "cbf29ce484222325";
                  r.strategies[s].counts["contacts"][i] = 0;
                }),
                ComparisonVerdict::less_true);
      plants += 2;
      if (row.guarantee != "complete") continue;
      // One pair dropped, which is not the first: only the digest and the number of contacts tell.
      EXPECT_EQ(planted([&](Record& r) {
                  r.strategies[s].digests[i] = "another";
                  --r.strategies[s].counts["contacts"][i];
                }),
                ComparisonVerdict::less_true);
      ++plants;
    }
  EXPECT_GE(plants, 15);
}

}  // namespace
}  // namespace cscd::bench
