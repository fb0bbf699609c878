#include "bench/compare/comparison.h"

#include <algorithm>

namespace cscd::bench {
namespace {

using Records = std::vector<Record>;

void compare_rows_present(const Record& before, const Record& after, Comparison& out) {
  const auto missing = [&](const Record& has, const Record& lacks, const char* side) {
    for (const StrategyRecord& row : has.strategies)
      if (lacks.strategy(row.name) == nullptr)
        out.only_in_one.push_back(has.scene.name + ": " + row.name + " only in " + side);
  };
  missing(before, after, "OLD");
  missing(after, before, "NEW");
}

void compare_scene(const std::string& scene, const Records& before, const Records& after, Comparison& out) {
  const Record &one = before.front(), &other = after.front();
  out.scenes.push_back(scene);
  compare_rows_present(one, other, out);
  const auto append = [](auto& to, auto from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  if (one.scene.digest != other.scene.digest)
    out.refusals.push_back({scene, "digests of contacts", "other scenes: the frames differ"});
  else if (one.elementary != other.elementary)
    out.refusals.push_back(
        {scene, "digests of contacts",
         "other pipelines: the elementary tests are " + one.elementary + " and " + other.elementary});
  out.compared_answers += compared_answers(one, other);
  append(out.truth, compare_truth(before, after));
  if (const std::string why = counters_refused(one, other); !why.empty()) {
    out.refusals.push_back({scene, "counters", why});
  } else {
    out.compared_counts += compared_counts(one, other);
    append(out.counters, compare_counters(one, other));
    append(out.footprint, compare_footprints(before, after));
  }
  if (out.lane != Lane::all) return;
  if (const std::string why = times_refused(before, after); !why.empty()) {
    out.refusals.push_back({scene, "times", why});
    if (one.scene.digest == other.scene.digest) {
      append(out.unjudged_times, unjudged_times(scene, before, after));
    } else {  // of other frames, so nothing is to be read from how they differ
      append(out.unjudged_times, unjudged_times(scene, before, {}));
      append(out.unjudged_times, unjudged_times(scene, {}, after));
    }
  }
}

// A scene that one side alone has.
void compare_with_none(const std::string& scene, std::span<const Record> before,
                       std::span<const Record> after, Comparison& out) {
  out.only_in_one.push_back(scene + ": only in " + (before.empty() ? "NEW" : "OLD"));
  if (out.lane != Lane::all) return;
  for (UnjudgedTime& time : unjudged_times(scene, before, after))
    out.unjudged_times.push_back(std::move(time));
}

// After all refusals are known, since how wide an interval is depends on how many there are.
void compare_all_times(const Side& before, const Side& after, Comparison& out) {
  std::vector<std::string> scenes;
  for (const std::string& scene : out.scenes)
    if (std::none_of(out.refusals.begin(), out.refusals.end(), [&](const Refusal& refusal) {
          return refusal.scene == scene && refusal.what == "times";
        }))
      scenes.push_back(scene);
  std::size_t count = 0;
  for (const std::string& scene : scenes)
    count += count_times(before.scenes.at(scene), after.scenes.at(scene));
  for (const std::string& scene : scenes)
    for (TimeFinding& finding : compare_times(before.scenes.at(scene), after.scenes.at(scene), count))
      out.times.push_back(std::move(finding));
  out.means = mean_over_scenes(out.times, count);
}

}  // namespace

ComparisonVerdict Comparison::verdict() const {
  const auto is_worse = [](const auto& finding) { return finding.change == Change::worse; };
  if (std::any_of(truth.begin(), truth.end(), [](const TruthFinding& finding) { return finding.is_lost; }))
    return ComparisonVerdict::less_true;
  if (std::any_of(counters.begin(), counters.end(), is_worse) ||
      std::any_of(footprint.begin(), footprint.end(), is_worse) ||
      std::any_of(times.begin(), times.end(), is_worse))
    return ComparisonVerdict::worse;
  return refusals.empty() ? ComparisonVerdict::nothing_worse : ComparisonVerdict::not_comparable;
}

Comparison compare(const Side& before, const Side& after, Lane lane) {
  Comparison out;
  out.lane = lane;
  out.old_commit = before.commit, out.new_commit = after.commit;
  out.old_dirty = before.dirty, out.new_dirty = after.dirty;
  for (const auto& [scene, records] : before.scenes)
    if (const auto same = after.scenes.find(scene); same != after.scenes.end())
      compare_scene(scene, records, same->second, out);
    else
      compare_with_none(scene, records, {}, out);
  for (const auto& [scene, records] : after.scenes)
    if (!before.scenes.contains(scene)) compare_with_none(scene, {}, records, out);
  if (out.scenes.empty())
    out.refusals.push_back({"", "everything", "OLD and NEW have no scene in common"});
  else if (out.compared_answers + out.compared_counts == 0 && lane == Lane::counters)
    out.refusals.push_back({"", "everything", "the records share no answer and no counter"});
  if (lane == Lane::all) compare_all_times(before, after, out);
  return out;
}

int exit_status(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::nothing_worse:
      return 0;
    case ComparisonVerdict::worse:
    case ComparisonVerdict::less_true:
      return 1;
    case ComparisonVerdict::not_comparable:
      break;
  }
  return 2;
}

std::string_view to_string(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::nothing_worse:
      return "nothing worse";
    case ComparisonVerdict::worse:
      return "worse";
    case ComparisonVerdict::less_true:
      return "less true";
    case ComparisonVerdict::not_comparable:
      break;
  }
  return "not comparable";
}

}  // namespace cscd::bench
