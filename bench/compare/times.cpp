#include "bench/compare/times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bench/compare/settings.h"
#include "bench/compare/side.h"
#include "bench/output/data.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"

namespace cscd::bench {

namespace {

constexpr std::string_view kPreparation = "preparation";
// What it takes to know what crosses at the start, outside of the query: a test of its own, or the look of a
// row that sees it.
constexpr std::string_view kStartStages[] = {"embedding", "start"};

std::vector<double> preparation_samples(const PreparationRecord& preparation) {
  std::vector<double> sums = preparation.distance_and_heat_ms;
  const std::vector<double>& rest = preparation.decomposition_ms;
  if (sums.empty()) return rest;
  for (std::size_t i = 0; i < std::min(sums.size(), rest.size()); ++i) sums[i] += rest[i];
  return sums;
}

void add_stage(const StrategyRecord& row, std::string_view stage, std::span<const std::size_t> columns,
               ProcessTimes& sums) {
  const auto found = row.ms.find(std::string(stage));
  if (found == row.ms.end()) return;
  sums.resize(found->second.size(), std::vector<double>(columns.size()));
  for (std::size_t r = 0; r < sums.size(); ++r)
    for (std::size_t i = 0; i < columns.size(); ++i) sums[r][i] += found->second[r][columns[i]];
}

using nlohmann::ordered_json;

constexpr std::string_view kStartTest = "embedding";
// How many standard errors below a change 4 of 5 estimates of it stay above (normal distribution).
constexpr double kPower = 0.842;
constexpr std::size_t kTimeGroups = 3;

const ordered_json& plan() {
  static const ordered_json data = data_json("comparison.json").at("times");
  return data;
}

bool matches(const ordered_json& pattern, const std::string& name) {
  return pattern == "*" || pattern == name;
}

// The larger of the relative floor and the absolute one, as a share of `before_ms`. A later line of the file
// takes the place of an earlier one.
double floor_of(const std::string& row, const std::string& stage, double before_ms) {
  double floor = 0;
  for (const ordered_json& line : plan().at("floors"))
    if (matches(line.at("row"), row) && matches(line.at("stage"), stage))
      floor = std::max(line.at("relative").get<double>(), line.at("absolute_ms").get<double>() / before_ms);
  return floor;
}

std::vector<std::size_t> shared_timed(std::span<const Record> before, std::span<const Record> after) {
  std::vector<std::size_t> shared = before.front().timed_intervals;
  const auto keep = [&](const Record& record) {
    std::vector<std::size_t> kept;
    for (const SharedInterval& i : shared_intervals(shared, record.timed_intervals))
      kept.push_back(i.interval);
    shared = std::move(kept);
  };
  for (const Record& record : before) keep(record);
  for (const Record& record : after) keep(record);
  return shared;
}

// The processes of one stage, in pairs, with the layouts that were paired.
struct Paired {
  std::vector<ProcessPair> pairs;
  std::vector<std::string> layouts;  // one a pair: old and new
};

Paired paired(std::span<const Record> before, std::span<const Record> after, const std::string& row,
              const std::string& stage, std::span<const std::size_t> intervals) {
  const auto samples = [&](const Record& record) {
    const StrategyRecord* strategy = record.strategy(row);
    return strategy == nullptr ? ProcessTimes() : stage_times(record, *strategy, stage, intervals);
  };
  const auto positive = [](const ProcessTimes& times) { return !times.empty() && process_time(times) > 0; };
  Paired out;
  for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k) {
    ProcessPair pair{samples(before[k]), samples(after[k])};
    if (!positive(pair.before) || !positive(pair.after)) continue;
    out.pairs.push_back(std::move(pair));
    out.layouts.push_back(layout_of(before[k]) + " " + layout_of(after[k]));
  }
  return out;
}

std::vector<std::vector<ProcessPair>> pairings(const Paired& all) {
  std::map<std::string, std::vector<ProcessPair>> by_layout;
  for (std::size_t i = 0; i < all.pairs.size(); ++i) by_layout[all.layouts[i]].push_back(all.pairs[i]);
  std::vector<std::vector<ProcessPair>> groups;
  if (by_layout.size() > 1) {
    for (auto& [layouts, pairs] : by_layout) groups.push_back(std::move(pairs));
    return groups;
  }
  groups.resize(std::min(kTimeGroups, all.pairs.size()));
  for (std::size_t i = 0; i < all.pairs.size(); ++i)
    groups[i * groups.size() / all.pairs.size()].push_back(all.pairs[i]);
  return groups;
}

double median_ms(const std::vector<ProcessPair>& pairs, ProcessTimes ProcessPair::*which) {
  std::vector<double> of_processes;
  for (const ProcessPair& pair : pairs) of_processes.push_back(process_time(pair.*which));
  return median(of_processes);
}

double half_width(std::size_t pairs, std::size_t comparisons) {
  const double miss = plan().at("false_reports");
  return interval_half_width(miss / static_cast<double>(std::max<std::size_t>(comparisons, 1)), pairs);
}

Estimate interval(double log_value, double half_width) {
  return {std::exp(log_value), std::exp(log_value - half_width), std::exp(log_value + half_width)};
}

TimeFinding judged(const Paired& all, const std::string& scene, const std::string& row,
                   const std::string& stage, std::size_t comparisons) {
  TimeFinding out{scene, row, stage, all.pairs.size()};
  out.before_ms = median_ms(all.pairs, &ProcessPair::before);
  out.after_ms = median_ms(all.pairs, &ProcessPair::after);
  out.resampled = bootstrap_process_ratio(all.pairs);
  const double effect = out.resampled.log_ratio, error = out.resampled.standard_error,
               width = half_width(all.pairs.size(), comparisons) * error;
  out.ratio = interval(effect, width);
  out.floor = floor_of(row, stage, out.before_ms);
  out.noise_floor = std::expm1(out.resampled.noise_floor);
  out.smallest_detectable = std::expm1(std::max(std::log1p(out.floor), width) + kPower * error);
  for (const std::vector<ProcessPair>& group : pairings(all)) {
    ++out.pairings;
    out.agreeing += log_process_ratio(group) * effect > 0;
  }
  if (out.ratio.low <= 1 && out.ratio.high >= 1) return out;
  if (std::abs(effect) < std::log1p(out.floor))
    out.withheld = "below the floor";
  else if (out.agreeing < out.pairings)
    out.withheld = "pairings disagree";
  else
    out.change = effect > 0 ? Change::worse : Change::better;
  return out;
}

// Calls `each` with row, stage and the pairs of every stage that enough pairs have.
template <class Each>
void for_each_stage(std::span<const Record> before, std::span<const Record> after, const Each& each) {
  const std::vector<std::size_t> intervals = shared_timed(before, after);
  bool start_test_compared = false;  // all rows that rely on it have the same samples of it
  for (const StrategyRecord& row : after.front().strategies)
    for (const std::string& stage : stages_of(row)) {
      if (stage == kStartTest && start_test_compared) continue;
      const Paired all = paired(before, after, row.name, stage, intervals);
      if (all.pairs.size() < plan().at("least_processes").get<std::size_t>()) continue;
      start_test_compared = start_test_compared || stage == kStartTest;
      each(row.name, stage, all);
    }
}

bool has_times(std::span<const Record> records) {
  return std::ranges::any_of(records, [](const Record& record) {
    return std::ranges::any_of(record.strategies, [](const StrategyRecord& row) { return !row.ms.empty(); });
  });
}

// What differs between the machines of two records; empty where nothing does.
std::string other_machine(const Record& one, const Record& other) {
  static const ordered_json keys = data_json("comparison.json").at("machine");
  for (const std::string key : keys)
    if (environment_text(one, key.c_str()) != environment_text(other, key.c_str()))
      return "other machines: " + key + " is " + environment_text(one, key.c_str()) + " and " +
             environment_text(other, key.c_str());
  return "";
}

// What differs between how two records were measured; empty where nothing does.
std::string other_measurement(const Record& one, const Record& other) {
  if (const std::string settings = other_settings(one, other); !settings.empty())
    return "other settings: " + settings;
  for (const StrategyRecord& row : one.strategies) {
    const StrategyRecord* same = other.strategy(row.name);
    if (same != nullptr && same->threads != row.threads)
      return "other threads: " + row.name + " ran on " + std::to_string(row.threads) + " and " +
             std::to_string(same->threads) + " threads";
  }
  if (environment_text(one, "build_type") != environment_text(other, "build_type"))
    return "other builds: " + environment_text(one, "build_type") + " and " +
           environment_text(other, "build_type");
  return "";
}

// Whether some of either side's processes ran between those of the other, so that slow hours of the machine
// hit both. Records are in order of their dates.
bool in_turns(std::span<const Record> before, std::span<const Record> after) {
  return environment_text(before.front(), "date") <= environment_text(after.back(), "date") &&
         environment_text(after.front(), "date") <= environment_text(before.back(), "date");
}

}  // namespace

std::vector<std::string> stages_of(const StrategyRecord& row) {
  std::vector<std::string> stages;
  for (const std::string_view stage : kQueryStages)
    if (row.ms.contains(std::string(stage))) stages.emplace_back(stage);
  if (!stages.empty()) stages.emplace_back(kTotal);
  for (const std::string_view stage : kStartStages)
    if (row.ms.contains(std::string(stage))) stages.emplace_back(stage);
  if (!preparation_samples(row.preparation).empty()) stages.emplace_back(kPreparation);
  return stages;
}

ProcessTimes stage_times(const Record& record, const StrategyRecord& row, const std::string& stage,
                         std::span<const std::size_t> intervals) {
  ProcessTimes sums;
  if (stage == kPreparation) {
    for (const double sample : preparation_samples(row.preparation)) sums.push_back({sample});
    return sums;
  }
  std::vector<std::size_t> columns;
  for (const SharedInterval& i : shared_intervals(record.timed_intervals, intervals))
    columns.push_back(i.before);
  if (columns.empty()) return sums;
  if (stage == kTotal)
    for (const std::string_view part : kQueryStages) add_stage(row, part, columns, sums);
  else
    add_stage(row, stage, columns, sums);
  return sums;
}

std::vector<double> stage_samples(const Record& record, const StrategyRecord& row, const std::string& stage) {
  std::vector<double> means;
  for (const std::vector<double>& repetition : stage_times(record, row, stage, record.timed_intervals))
    means.push_back(mean(repetition));
  return means;
}

std::string times_refused(std::span<const Record> before, std::span<const Record> after) {
  if (!has_times(before) || !has_times(after)) return "a side has no times";
  if (before.front().scene.digest != after.front().scene.digest) return "other scenes: the frames differ";
  for (const std::span<const Record> side : {before, after})
    for (const Record& record : side) {
      if (const std::string why = other_machine(before.front(), record); !why.empty()) return why;
      if (const std::string why = other_measurement(before.front(), record); !why.empty()) return why;
    }
  if (shared_timed(before, after).empty()) return "no interval was timed in all records";
  const std::size_t least = plan().at("least_processes"), have = std::min(before.size(), after.size());
  if (have < least)
    return "the smaller side has " + std::to_string(have) + (have == 1 ? " process" : " processes") +
           ", and how processes vary shows from " + std::to_string(least) +
           " on; measure with scripts/compare-commits";
  if (!in_turns(before, after))
    return "one side was measured after the other, so drift of the machine cannot be told from a change; "
           "measure in turns with scripts/compare-commits";
  return "";
}

std::size_t count_times(std::span<const Record> before, std::span<const Record> after) {
  std::size_t count = 0;
  for_each_stage(before, after, [&](const auto&...) { ++count; });
  return count;
}

std::vector<TimeFinding> compare_times(std::span<const Record> before, std::span<const Record> after,
                                       std::size_t comparisons) {
  std::vector<TimeFinding> out;
  for_each_stage(before, after, [&](const std::string& row, const std::string& stage, const Paired& all) {
    out.push_back(judged(all, after.front().scene.name, row, stage, comparisons));
    out.back().of_shortfall = shortfall(after.front(), row).has_value();
  });
  return out;
}

std::vector<UnjudgedTime> unjudged_times(const std::string& scene, std::span<const Record> before,
                                         std::span<const Record> after) {
  std::vector<std::size_t> shared;
  if (!before.empty() && !after.empty()) shared = shared_timed(before, after);
  const auto typical = [&](std::span<const Record> side, const std::string& row) -> std::optional<double> {
    std::vector<double> of_processes;
    for (const Record& record : side) {
      const StrategyRecord* strategy = record.strategy(row);
      if (strategy == nullptr) continue;
      const ProcessTimes times = stage_times(record, *strategy, std::string(kTotal),
                                             shared.empty() ? record.timed_intervals : shared);
      if (!times.empty()) of_processes.push_back(process_time(times));
    }
    if (of_processes.empty()) return std::nullopt;
    return median(of_processes);
  };
  std::vector<UnjudgedTime> out;
  for (const std::span<const Record> side : {after, before})
    for (const StrategyRecord& row :
         side.empty() ? std::span<const StrategyRecord>() : side.front().strategies) {
      if (std::ranges::find(out, row.name, &UnjudgedTime::row) != out.end()) continue;
      UnjudgedTime time{scene, row.name, typical(before, row.name), typical(after, row.name),
                        shortfall(side.front(), row.name).has_value()};
      if (time.before_ms || time.after_ms) out.push_back(std::move(time));
    }
  return out;
}

std::vector<MeanFinding> mean_over_scenes(std::span<const TimeFinding> times, std::size_t comparisons) {
  std::map<std::string, std::vector<const TimeFinding*>> by_row;
  std::vector<std::string> rows;
  for (const TimeFinding& time : times) {
    if (time.stage != kTotal) continue;
    if (!by_row.contains(time.row)) rows.push_back(time.row);
    by_row[time.row].push_back(&time);
  }
  std::vector<MeanFinding> out;
  for (const std::string& row : rows) {
    const std::vector<const TimeFinding*>& scenes = by_row[row];
    const double share = 1 / static_cast<double>(scenes.size());
    double log_mean = 0;
    std::size_t pairs = scenes.front()->pairs;
    std::vector<double> resampled(scenes.front()->resampled.resampled.size());
    for (const TimeFinding* scene : scenes) {
      log_mean += share * scene->resampled.log_ratio;
      pairs = std::min(pairs, scene->pairs);
      for (std::size_t i = 0; i < resampled.size(); ++i)
        resampled[i] += share * scene->resampled.resampled[i];
    }
    out.push_back({row, scenes.size(),
                   interval(log_mean, half_width(pairs, comparisons) * standard_deviation(resampled))});
  }
  return out;
}

}  // namespace cscd::bench
