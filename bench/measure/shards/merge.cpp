#include "bench/measure/shards/merge.h"

#include <algorithm>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/pipeline.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kListedDifferences = 200;  // as many as a single run lists

std::optional<fs::path> find_result(const PlanCell& cell, std::span<const fs::path> folders) {
  std::error_code ignored;
  for (const fs::path& folder : folders)
    if (fs::path path = folder / result_name(cell); fs::exists(path, ignored)) return path;
  return std::nullopt;
}

// What has to be the same wherever the results of one record were measured: all but the moment.
ordered_json place_of(const Record& record) {
  ordered_json place = record.environment;
  for (const char* key : {"date", "load_average"}) place.erase(key);
  return place;
}

std::vector<std::string> names_of(const Record& record) {
  std::vector<std::string> names;
  for (const StrategyRecord& strategy : record.strategies) names.push_back(strategy.name);
  return names;
}

void require_of_cell(const Plan& plan, const PlanCell& cell, const Record& record, const fs::path& path) {
  const auto require = [&](bool holds, const char* what) {
    if (!holds)
      throw InputError("result " + path.string() + ": its " + what + " not those of cell " + cell.id +
                       "; remove the file, and measure the cell again");
  };
  require(record.scene.digest == plan.frames_digest, "frames are");
  require(names_of(record) == plan.replay.request.strategies, "strategies are");
  require(
      record.counted_intervals == cell.intervals.counted && record.timed_intervals == cell.intervals.timed,
      "intervals are");
  for (const char* key : {"commit", "dirty", "instruction_set"})
    require(record.environment.value(key, ordered_json()) == plan.code.at(key),
            "commit and instruction set are");
}

// Throws InputError, naming what differs, unless two results were measured in the same place.
void require_same_place(const Record& a, const fs::path& a_path, const Record& b, const fs::path& b_path) {
  const ordered_json first = place_of(a), second = place_of(b);
  for (const auto& [key, value] : first.items())
    if (!second.contains(key) || second[key] != value)
      throw InputError(
          "results " + a_path.string() + " and " + b_path.string() + ": differ in their environment (" + key +
          ": " + value.dump() + " and " + (second.contains(key) ? second[key].dump() : "nothing") +
          "); measure all cells with one build" + (first.contains("cpu") ? " on one kind of machine" : ""));
}

template <class T>
void append(const std::vector<T>& more, std::vector<T>& to) {
  to.insert(to.end(), more.begin(), more.end());
}

void require_same_columns(bool same, const std::string& strategy, const PlanCell& cell) {
  if (!same)
    throw InputError("cell " + cell.id + ": its columns of " + strategy +
                     " are not those of the cells before it; remove its result, and measure it again");
}

// Appends the rows of a cell. A cell in which nothing is timed has no times.
void append(const TimeColumns& more, const std::string& strategy, const PlanCell& cell, TimeColumns& to) {
  if (more.empty()) return;
  if (to.empty()) {
    to = more;
    return;
  }
  require_same_columns(
      std::ranges::equal(more, to, {}, &TimeColumns::value_type::first, &TimeColumns::value_type::first),
      strategy, cell);
  for (auto& [stage, repetitions] : to) {
    const auto& rows = more.at(stage);
    require_same_columns(rows.size() == repetitions.size(), strategy, cell);
    for (std::size_t r = 0; r < rows.size(); ++r) append(rows[r], repetitions[r]);
  }
}

template <class T>
void keep_largest(const std::optional<T>& value, std::optional<T>& kept) {
  if (value && (!kept || *kept < *value)) kept = value;
}

// The mean of instructions over intervals, from the means of two sets of so many intervals.
void add_instructions(const std::optional<double>& more, std::size_t more_intervals,
                      std::optional<double>& mean, std::size_t intervals) {
  if (!more || more_intervals == 0) return;
  const auto a = static_cast<double>(intervals), b = static_cast<double>(more_intervals);
  mean = mean && intervals > 0 ? (*mean * a + *more * b) / (a + b) : *more;
}

// `timed` is how many timed intervals `to` has already.
void append(const StrategyRecord& more, const PlanCell& cell, std::size_t timed, StrategyRecord& to) {
  append(more.preparation.distance_and_heat_ms, to.preparation.distance_and_heat_ms);
  append(more.preparation.decomposition_ms, to.preparation.decomposition_ms);
  keep_largest(more.footprint.peak_bytes, to.footprint.peak_bytes);
  keep_largest(more.footprint.held_bytes, to.footprint.held_bytes);
  add_instructions(more.footprint.instructions, cell.intervals.timed.size(), to.footprint.instructions,
                   timed);
  require_same_columns(std::ranges::equal(more.counts, to.counts, {}, &CountColumns::value_type::first,
                                          &CountColumns::value_type::first),
                       to.name, cell);
  for (auto& [key, column] : to.counts) append(more.counts.at(key), column);
  append(more.digests, to.digests);
  append(more.first_times, to.first_times);
  append(more.ms, to.name, cell, to.ms);
}

void append_own_tests(const ordered_json& more, ordered_json& to) {
  for (std::size_t i = 0; i < to.size() && i < more.size(); ++i) {
    ordered_json& row = to[i];
    for (const char* key : {"misses", "false_alarms"})
      row[key] = row[key].get<std::uint64_t>() + more[i].at(key).get<std::uint64_t>();
    row["largest_time_error"] =
        std::max(row["largest_time_error"].get<double>(), more[i].at("largest_time_error").get<double>());
    for (const ordered_json& difference : more[i].at("differences"))
      if (row["differences"].size() < kListedDifferences) row["differences"].push_back(difference);
  }
}

void append(const VerificationRecord& more, VerificationRecord& to) {
  append(more.intervals, to.intervals);
  append(more.unembedded, to.unembedded);
  append(more.colliding, to.colliding);
  append(more.disagreeing, to.disagreeing);
  append(more.excused, to.excused);
  for (std::size_t i = 0; i < to.strategies.size(); ++i) {
    VerifiedStrategy& row = to.strategies[i];
    const VerifiedStrategy& added = more.strategies.at(i);
    row.contacts_expected += added.contacts_expected;
    row.contacts_found += added.contacts_found;
    row.intervals_promised += added.intervals_promised;
    append(added.failures, row.failures);
  }
  to.accuracy.add(more.accuracy);
  to.accuracy_tests += more.accuracy_tests;
  append_own_tests(more.own_tests, to.own_tests);
  to.seconds += more.seconds;
}

// What is left of a strategy where some strategy broke its promise, as in a single run.
void leave_out_measurements(StrategyRecord& strategy) {
  strategy.footprint = {};
  strategy.counts.clear();
  strategy.digests.clear();
  strategy.first_times.clear();
  strategy.ms.clear();
}

struct Result {
  fs::path path;
  Record record;
};

Result read_result(const Plan& plan, const PlanCell& cell, std::span<const fs::path> folders) {
  const std::optional<fs::path> path = find_result(cell, folders);
  if (!path)
    throw InputError("cell " + cell.id + ", " + frames_text(cell) +
                     ": has no result; measure it with `cscd run --plan`");
  Result result{*path, read_record(*path)};
  require_of_cell(plan, cell, result.record, result.path);
  return result;
}

}  // namespace

std::vector<const PlanCell*> missing_cells(const Plan& plan, std::span<const fs::path> folders) {
  std::vector<const PlanCell*> missing;
  for (const PlanCell& cell : plan.cells)
    if (!find_result(cell, folders)) missing.push_back(&cell);
  return missing;
}

Record merge(const Plan& plan, std::span<const fs::path> folders) {
  const Result first = read_result(plan, plan.cells.front(), folders);
  Record merged = first.record;
  bool ok = merged.verification.ok();
  for (std::size_t i = 1; i < plan.cells.size(); ++i) {
    const PlanCell& cell = plan.cells[i];
    const Result next = read_result(plan, cell, folders);
    require_same_place(first.record, first.path, next.record, next.path);
    append(next.record.verification, merged.verification);
    ok = ok && next.record.verification.ok();
    for (std::size_t s = 0; s < merged.strategies.size() && ok; ++s)
      append(next.record.strategies[s], cell, merged.timed_intervals.size(), merged.strategies[s]);
    append(next.record.counted_intervals, merged.counted_intervals);
    append(next.record.timed_intervals, merged.timed_intervals);
  }
  if (!ok) std::ranges::for_each(merged.strategies, leave_out_measurements);
  const IntervalRange& range = plan.replay.intervals.range;
  merged.intervals = range.last - range.first;
  // Times of several processes are not one process's; counts are the same in any number of them.
  if (plan.replay.kind == ReplayKind::timings) merged.processes = plan.cells.size();
  return merged;
}

}  // namespace cscd::bench
