#include "bench/compare/comparison.h"

#include <algorithm>

#include "bench/compare/settings.h"

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
  const std::string settings = other_settings(one, other);
  if (one.scene.digest != other.scene.digest)
    out.refusals.push_back({scene, "digests of contacts", "other scenes: the frames differ"});
  else if (!settings.empty())
    out.refusals.push_back({scene, "digests of contacts", "other settings: " + settings});
  out.compared_answers += compared_answers(one, other);
  append(out.truth, compare_truth(before, after));
  if (const std::string why = counters_refused(one, other); !why.empty()) {
    out.refusals.push_back({scene, "counters", why});
  } else {
    out.compared_counts += compared_counts(one, other);
    append(out.counters, compare_counters(one, other));
    for (const std::string& row : rows_of_other_settings(one, other))
      out.refusals.push_back({scene, "counters of some rows", row});
    append(out.footprint, compare_footprints(before, after));
  }
  if (out.lane != Lane::all) return;
  if (const std::string why = times_refused(before, after); !why.empty()) {
    out.refusals.push_back({scene, "times", why});
    if (one.scene.digest == other.scene.digest && settings.empty()) {
      append(out.unjudged_times, unjudged_times(scene, before, after));
    } else {  // of other frames or settings, so nothing is to be read from how they differ
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
    if (std::ranges::none_of(out.refusals, [&](const Refusal& refusal) {
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

// Gives the scenes of the new side the names of those of the old side that were asked the same: a thickness
// may be written in edges or in units.
void name_alike(const Side& before, Side& after) {
  for (const auto& [name, records] : before.scenes) {
    if (after.scenes.contains(name)) continue;
    const auto same = std::ranges::find_if(after.scenes, [&, &records = records](const auto& scene) {
      return !before.scenes.contains(scene.first) && asks_the_same(records.front(), scene.second.front());
    });
    if (same == after.scenes.end()) continue;
    auto node = after.scenes.extract(same);
    node.key() = name;
    after.scenes.insert(std::move(node));
  }
}

// Where both sides have a scene, but with other settings: how these differ, for the first such scene.
std::string why_not_in_common(const Side& before, const Side& after) {
  for (const auto& [name, records] : before.scenes)
    for (const auto& [other_name, others] : after.scenes)
      if (bare_name(records.front()) == bare_name(others.front()))
        return "; they have " + bare_name(records.front()) +
               " with other settings: " + other_settings(records.front(), others.front());
  return "";
}

using nlohmann::ordered_json;

ordered_json interval_json(const Estimate& ratio) {
  return {ratio.low, ratio.high};
}

}  // namespace

ComparisonVerdict Comparison::verdict() const {
  const auto is_worse = [](const auto& finding) { return finding.change == Change::worse; };
  if (std::ranges::any_of(truth, [](const TruthFinding& finding) { return finding.is_lost; }))
    return ComparisonVerdict::less_true;
  if (std::ranges::any_of(counters, is_worse) || std::ranges::any_of(footprint, is_worse) ||
      std::ranges::any_of(times, is_worse))
    return ComparisonVerdict::worse;
  return refusals.empty() ? ComparisonVerdict::nothing_worse : ComparisonVerdict::not_comparable;
}

Comparison compare(const Side& before, Side after, Lane lane) {
  name_alike(before, after);
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
    out.refusals.push_back(
        {"", "everything", "OLD and NEW have no scene in common" + why_not_in_common(before, after)});
  else if (out.compared_answers + out.compared_counts == 0 && lane == Lane::counters)
    out.refusals.push_back({"", "everything", "the records share no answer and no counter"});
  if (lane == Lane::all) compare_all_times(before, after, out);
  return out;
}

ExitStatus exit_status(ComparisonVerdict verdict) {
  switch (verdict) {
    case ComparisonVerdict::nothing_worse:
      return ExitStatus::done;
    case ComparisonVerdict::worse:
    case ComparisonVerdict::less_true:
      return ExitStatus::failed;
    case ComparisonVerdict::not_comparable:
      break;
  }
  return ExitStatus::refused;
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

ordered_json comparison_json(const Comparison& c) {
  const auto side = [](const std::string& commit, bool dirty) {
    return ordered_json{{"commit", commit}, {"dirty", dirty}};
  };
  ordered_json truth = ordered_json::array(), counters = ordered_json::array(),
               footprint = ordered_json::array(), times = ordered_json::array(),
               unjudged = ordered_json::array(), means = ordered_json::array(),
               refusals = ordered_json::array();
  for (const TruthFinding& f : c.truth)
    truth.push_back({{"scene", f.scene}, {"row", f.row}, {"text", f.text}, {"lost", f.is_lost}});
  for (const CounterFinding& f : c.counters)
    counters.push_back({{"scene", f.scene},
                        {"row", f.row},
                        {"counter", f.counter},
                        {"old", f.before},
                        {"new", f.after},
                        {"intervals", f.intervals},
                        {"intervals_that_differ", f.intervals_that_differ},
                        {"change", to_string(f.change)}});
  for (const FootprintFinding& f : c.footprint)
    footprint.push_back({{"scene", f.scene},
                         {"row", f.row},
                         {"what", f.what},
                         {"old", f.before},
                         {"new", f.after},
                         {"change", to_string(f.change)}});
  for (const TimeFinding& f : c.times)
    times.push_back({{"scene", f.scene},
                     {"row", f.row},
                     {"stage", f.stage},
                     {"pairs", f.pairs},
                     {"old_ms", f.before_ms},
                     {"new_ms", f.after_ms},
                     {"ratio", f.ratio.value},
                     {"interval", interval_json(f.ratio)},
                     {"floor", f.floor},
                     {"noise_floor", f.noise_floor},
                     {"smallest_detectable", f.smallest_detectable},
                     {"pairings", f.pairings},
                     {"pairings_that_agree", f.agreeing},
                     {"change", to_string(f.change)},
                     {"withheld", f.withheld},
                     {"of_shortfall", f.of_shortfall}});
  const auto number_or_null = [](const std::optional<double>& value) {
    return value ? ordered_json(*value) : ordered_json();
  };
  for (const UnjudgedTime& t : c.unjudged_times)
    unjudged.push_back({{"scene", t.scene},
                        {"row", t.row},
                        {"old_ms", number_or_null(t.before_ms)},
                        {"new_ms", number_or_null(t.after_ms)},
                        {"of_shortfall", t.of_shortfall}});
  for (const MeanFinding& f : c.means)
    means.push_back({{"row", f.row},
                     {"scenes", f.scenes},
                     {"ratio", f.ratio.value},
                     {"interval", interval_json(f.ratio)}});
  for (const Refusal& f : c.refusals)
    refusals.push_back({{"scene", f.scene}, {"what", f.what}, {"reason", f.reason}});
  return {{"schema", kComparisonSchema},
          {"verdict", to_string(c.verdict())},
          {"lane", c.lane == Lane::counters ? "counters" : "all"},
          {"old", side(c.old_commit, c.old_dirty)},
          {"new", side(c.new_commit, c.new_dirty)},
          {"scenes", c.scenes},
          {"only_in_one", c.only_in_one},
          {"truth", std::move(truth)},
          {"answers_compared", c.compared_answers},
          {"counts_compared", c.compared_counts},
          {"counters", std::move(counters)},
          {"footprint", std::move(footprint)},
          {"times", std::move(times)},
          {"unjudged_times", std::move(unjudged)},
          {"geometric_means", std::move(means)},
          {"not_compared", std::move(refusals)}};
}

}  // namespace cscd::bench
