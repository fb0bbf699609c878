#include "bench/compare/comparison.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

ordered_json interval_json(const Estimate& ratio) {
  return {ratio.low, ratio.high};
}

}  // namespace

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
