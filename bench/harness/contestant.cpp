#include "bench/harness/contestant.h"

#include <algorithm>

#include "bench/harness/footprint.h"
#include "bench/inputs/thickness.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {
namespace {

void add(const Preparation& sample, PreparationRecord& record) {
  if (sample.distance_and_heat_ms) record.distance_and_heat_ms.push_back(*sample.distance_and_heat_ms);
  if (sample.decomposition_ms) record.decomposition_ms.push_back(*sample.decomposition_ms);
  if (!sample.atomic_cluster.empty()) record.atomic_clusters = sample.atomic_clusters;
}

}  // namespace

StrategyInput measured_setup(const Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                             bool first_only, Pipeline pipeline) {
  StrategyInput setup =
      setup_for(strategy, input.setup(elementary, first_only, pipeline), input.clip->interval_count());
  // What is left out by distance includes what is ignored.
  if (input.ignored && !input.thickness.left_out) setup.exclusions = &input.ignored->triangles;
  return setup;
}

// What is ignored is dropped before it is tested. That is right where a strategy passes on all contacts.
std::optional<std::string> why_not_ignoring(const Input& input, const Strategy& strategy) {
  if (!input.ignored) return std::nullopt;
  if (strategy.own_test) return "its elementary test is its own, and knows nothing of what is ignored";
  if (strategy.guarantee == Guarantee::first_contact)
    return "it promises the first contact alone, which may be an ignored one";
  if (strategy.guarantee == Guarantee::heuristic) return "it promises nothing of what is not ignored";
  return std::nullopt;
}

Contestant make_contestant(Input& input, const StrategyRow& row, const ElementaryTest& exact,
                           const ElementaryTest& timed, std::optional<std::size_t> interval) {
  Contestant contestant{.row = row, .judged = nullptr, .timed = nullptr, .preparation = {}};
  const auto made = [&](const ElementaryTest& test) -> std::shared_ptr<Detector> {
    Prepared prepared =
        row.strategy->make(measured_setup(input, *row.strategy, test, row.first, row.pipeline));
    add(prepared.preparation, contestant.preparation);
    contestant.threads = prepared.preparation.threads;
    return std::move(prepared.detector);
  };
  if (&exact != &timed) contestant.judged = made(exact);
  std::optional<scenes::ClipInterval> asked;
  std::optional<ResidentMemory> memory;
  if (interval) {
    asked = input.clip->load(*interval);  // the source's own buffers are not the strategy's
    memory.emplace();
  }
  const Stopwatch making;
  contestant.timed = made(timed);
  contestant.make_ms = making.milliseconds();
  if (memory) {
    ContactSet found;
    for (int time = 0; time < 2; ++time) contestant.timed->detect(input.step(*asked), found);
    contestant.footprint = memory->footprint();
  }
  if (!contestant.judged) contestant.judged = contestant.timed;
  return contestant;
}

std::vector<Contestant> make_contestants(Input& input, std::span<const StrategyRow> rows,
                                         const ElementaryTest& exact, const ElementaryTest& timed) {
  Progress progress("preparing " + input.name, rows.size());
  std::vector<Contestant> contestants;
  for (const StrategyRow& row : rows) {
    contestants.push_back(make_contestant(input, row, exact, timed));
    progress.advance();
  }
  return contestants;
}

std::vector<StrategyRow> chosen_rows(const Input& input, std::span<const std::string> texts,
                                     Pipeline pipeline) {
  const auto has = [&](const StrategyRow& row) {
    return pipeline == Pipeline::vectorised || row.strategy->kind == StrategyKind::published;
  };
  std::vector<StrategyRow> chosen;
  const auto add = [&](StrategyRow row) {
    row.pipeline = pipeline;
    if (std::ranges::find(chosen, row) == chosen.end()) chosen.push_back(row);
  };
  const auto add_of_group = [&](const StrategyRow& row) {
    if (has(row) && allows(input, *row.strategy) && !why_not_ignoring(input, *row.strategy) &&
        why_not_within(input.thickness.asked, *row.strategy).empty())
      add(row);
  };
  if (texts.empty())
    for (const Strategy* strategy : strategies_in("")) add_of_group({strategy});
  for (const std::string& text : texts)
    for (const StrategyRow& row : rows_called({&text, 1})) {
      if (row.name() != text) {
        add_of_group(row);
        continue;
      }
      if (!has(row))
        throw InputError("strategy " + text +
                         " is not of the paper, so the pipeline published does not have it; leave it out, or "
                         "run it with --pipeline today");
      require_fit(input.thickness.asked, *row.strategy);
      if (const auto reason = why_not_ignoring(input, *row.strategy))
        throw InputError("strategy " + text + " cannot leave out what is ignored: " + *reason +
                         "; leave the strategy out, or --ignore and --ignore-neighbours");
      add(row);
    }
  return chosen;
}

void lead_up(const Strategy& strategy, Detector& detector, Input& input, const IntervalRange& lead) {
  if (strategy.kind != StrategyKind::adaptive) return;
  detector.forget();
  ContactSet ignored;
  for (std::size_t i = lead.first; i < lead.last; ++i) {
    const scenes::ClipInterval before = input.clip->load(i);
    detector.detect(input.step(before), ignored);
  }
}

void ask(Detector& detector, const StrategyRow& row, const Step& step, Answered& out) {
  out.report = detector.detect(step, out.found);
  out.found.sort();
  if (row.first) keep_first(out.found);
}

}  // namespace cscd::bench
