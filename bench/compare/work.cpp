#include "bench/compare/work.h"

#include <algorithm>
#include <cmath>

#include "bench/compare/settings.h"
#include "bench/compare/side.h"
#include "bench/output/data.h"
#include "bench/statistics/statistics.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

// Counters whose values are answers; compare_truth judges these.
constexpr std::string_view kAnswers[] = {"contacts", "undecided"};

bool is_answer(const std::string& counter) {
  return std::find(std::begin(kAnswers), std::end(kAnswers), counter) != std::end(kAnswers);
}

template <class Each>
void for_each_counter(const Record& before, const Record& after, const Each& each) {
  for (const StrategyRecord& new_row : after.strategies) {
    const StrategyRecord* old_row = before.strategy(new_row.name);
    if (old_row == nullptr || !other_row_settings(*old_row, new_row).empty()) continue;
    for (const auto& [counter, new_column] : new_row.counts)
      if (const auto old_column = old_row->counts.find(counter);
          old_column != old_row->counts.end() && !is_answer(counter))
        each(new_row.name, counter, old_column->second, new_column);
  }
}

// Without fused multiply-add, certificates in single precision round otherwise (bench/METHODOLOGY.md).
bool has_fma(const Record& record) {
  const std::string set = environment_text(record, "instruction_set");
  return set == "AVX-512" || set == "AVX2 and FMA";
}

std::optional<double> median_of(std::span<const Record> records, const std::string& row,
                                const std::string& what) {
  std::vector<double> values;
  for (const Record& record : records) {
    const StrategyRecord* strategy = record.strategy(row);
    if (strategy == nullptr) continue;
    const Footprint& footprint = strategy->footprint;
    if (what == "peak_bytes" && footprint.peak_bytes)
      values.push_back(static_cast<double>(*footprint.peak_bytes));
    if (what == "held_bytes" && footprint.held_bytes)
      values.push_back(static_cast<double>(*footprint.held_bytes));
    if (what == "instructions" && footprint.instructions) values.push_back(*footprint.instructions);
  }
  if (values.empty()) return {};
  return median(values);
}

}  // namespace

std::string_view to_string(Change change) {
  switch (change) {
    case Change::same:
      return "same";
    case Change::better:
      return "better";
    case Change::worse:
      return "worse";
    case Change::different:
      break;
  }
  return "different";
}

std::string counters_refused(const Record& before, const Record& after) {
  if (before.scene.digest != after.scene.digest) return "the scene moves differently";
  if (const std::string settings = other_settings(before, after); !settings.empty())
    return "other settings: " + settings;
  if (has_fma(before) != has_fma(after))
    return "instruction sets with and without fused multiply-add round differently (" +
           environment_text(before, "instruction_set") + ", " + environment_text(after, "instruction_set") +
           ")";
  return "";
}

std::vector<std::string> rows_of_other_settings(const Record& before, const Record& after) {
  std::vector<std::string> out;
  for (const StrategyRecord& row : after.strategies)
    if (const StrategyRecord* same = before.strategy(row.name))
      if (std::string why = other_row_settings(*same, row); !why.empty()) out.push_back(std::move(why));
  return out;
}

std::size_t compared_counts(const Record& before, const Record& after) {
  const std::size_t intervals = shared_intervals(before.counted_intervals, after.counted_intervals).size();
  std::size_t count = 0;
  for_each_counter(before, after, [&](const auto&...) { count += intervals; });
  return count;
}

std::vector<CounterFinding> compare_counters(const Record& before, const Record& after) {
  const ordered_json costs = data_json("comparison.json").at("costs");
  const auto shared = shared_intervals(before.counted_intervals, after.counted_intervals);
  std::vector<CounterFinding> out;
  for_each_counter(
      before, after,
      [&](const std::string& row, const std::string& counter, const std::vector<std::uint64_t>& old_column,
          const std::vector<std::uint64_t>& new_column) {
        CounterFinding finding{after.scene.name, row, counter, 0, 0, shared.size(), 0, Change::different};
        for (const SharedInterval& i : shared) {
          finding.before += old_column[i.before];
          finding.after += new_column[i.after];
          finding.intervals_that_differ += old_column[i.before] != new_column[i.after];
        }
        if (finding.intervals_that_differ == 0) return;
        const bool is_cost = std::ranges::find(costs, ordered_json(counter)) != costs.end();
        if (is_cost && finding.before != finding.after)
          finding.change = finding.after > finding.before ? Change::worse : Change::better;
        out.push_back(std::move(finding));
      });
  return out;
}

std::vector<FootprintFinding> compare_footprints(std::span<const Record> before,
                                                 std::span<const Record> after) {
  const ordered_json floors = data_json("comparison.json").at("footprint");
  std::vector<FootprintFinding> out;
  for (const StrategyRecord& row : after.front().strategies)
    for (const auto& [what, floor] : floors.items()) {
      const auto old_value = median_of(before, row.name, what), new_value = median_of(after, row.name, what);
      if (!old_value || !new_value) continue;
      const double difference = *new_value - *old_value;
      if (std::abs(difference) <= floor.at("absolute").get<double>() ||
          std::abs(difference) <= floor.at("relative").get<double>() * *old_value)
        continue;
      out.push_back({after.front().scene.name, row.name, what, *old_value, *new_value,
                     difference > 0 ? Change::worse : Change::better});
    }
  return out;
}

}  // namespace cscd::bench
