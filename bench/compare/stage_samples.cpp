#include "bench/compare/stage_samples.h"

#include <algorithm>

#include "bench/compare/side.h"
#include "bench/compare/statistics/statistics.h"

namespace cscd::bench {
namespace {

constexpr std::string_view kQueryStages[] = {"refit", "rv_update", "traversal", "elementary"};
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

}  // namespace cscd::bench
