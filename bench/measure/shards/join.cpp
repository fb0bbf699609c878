#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "bench/measure/shards/shards.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kListedDifferences = 200;  // as many as a single run lists
constexpr char kAgain[] = "; remove the file, and run the command again";

Record read_result(const RunShard& shard, const fs::path& path) {
  Record record = read_record(path);
  if (record.command != shard.replay.command || record.counted_intervals != shard.replay.section.counted ||
      record.timed_intervals != shard.replay.section.timed)
    throw InputError("result " + path.string() + ": its command or its intervals are not those of its shard" +
                     kAgain);
  return record;
}

// Throws InputError, naming what differs, unless two results were measured by one build and, where they tell
// of it, on one kind of machine.
void require_same_place(ordered_json first, const fs::path& a, ordered_json second, const fs::path& b) {
  for (const char* varies : {"date", "load_average", "process"}) {
    first.erase(varies);
    second.erase(varies);
  }
  for (const auto& [key, value] : first.items())
    if (!second.contains(key) || second[key] != value)
      throw InputError(
          "results " + a.string() + " and " + b.string() + ": differ in their environment (" + key + ": " +
          value.dump() + " and " + (second.contains(key) ? second[key].dump() : "nothing") +
          "); measure all shards with one build" + (first.contains("cpu") ? " on one kind of machine" : ""));
}

template <class T>
void append(const std::vector<T>& more, std::vector<T>& to) {
  to.insert(to.end(), more.begin(), more.end());
}

void require_same_columns(bool same, const std::string& strategy, const fs::path& path) {
  if (!same)
    throw InputError("result " + path.string() + ": its columns of " + strategy +
                     " are not those of the shards before it" + kAgain);
}

// Appends the rows of a shard. A shard in which nothing is timed has no times.
void append(const TimeColumns& more, const std::string& strategy, const fs::path& path, TimeColumns& to) {
  if (more.empty()) return;
  if (to.empty()) {
    to = more;
    return;
  }
  require_same_columns(
      std::ranges::equal(more, to, {}, &TimeColumns::value_type::first, &TimeColumns::value_type::first),
      strategy, path);
  for (auto& [stage, repetitions] : to) {
    const auto& rows = more.at(stage);
    require_same_columns(rows.size() == repetitions.size(), strategy, path);
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
void append(const StrategyRecord& more, const RunShard& shard, const fs::path& path, std::size_t timed,
            StrategyRecord& to) {
  append(more.preparation.distance_and_heat_ms, to.preparation.distance_and_heat_ms);
  append(more.preparation.decomposition_ms, to.preparation.decomposition_ms);
  keep_largest(more.footprint.peak_bytes, to.footprint.peak_bytes);
  keep_largest(more.footprint.held_bytes, to.footprint.held_bytes);
  add_instructions(more.footprint.instructions, shard.replay.section.timed.size(), to.footprint.instructions,
                   timed);
  require_same_columns(std::ranges::equal(more.counts, to.counts, {}, &CountColumns::value_type::first,
                                          &CountColumns::value_type::first),
                       to.name, path);
  for (auto& [key, column] : to.counts) append(more.counts.at(key), column);
  append(more.digests, to.digests);
  append(more.first_times, to.first_times);
  append(more.ms, to.name, path, to.ms);
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

}  // namespace

Record join(const Replay& whole, std::span<const RunShard> shards, const fs::path& folder) {
  std::set<ordered_json> processes;
  fs::path first_path;
  Record joined;
  bool ok = true;
  for (const RunShard& shard : shards) {
    const fs::path path = folder / shard.file_name;
    Record next = read_result(shard, path);
    if (next.environment.contains("process")) processes.insert(next.environment["process"]);
    ok = ok && next.verification.ok();
    if (first_path.empty()) {
      first_path = path;
      joined = std::move(next);
      continue;
    }
    require_same_place(joined.environment, first_path, next.environment, path);
    append(next.verification, joined.verification);
    for (std::size_t s = 0; s < joined.strategies.size() && ok; ++s)
      append(next.strategies[s], shard, path, joined.timed_intervals.size(), joined.strategies[s]);
    append(next.counted_intervals, joined.counted_intervals);
    append(next.timed_intervals, joined.timed_intervals);
  }
  if (!ok) std::ranges::for_each(joined.strategies, leave_out_measurements);
  joined.environment.erase("process");
  joined.intervals = whole.range.last - whole.range.first;
  // Times of several processes are not one process's; counts are the same in any number of them.
  joined.processes = std::max<std::size_t>(1, processes.size());
  return joined;
}

}  // namespace cscd::bench
