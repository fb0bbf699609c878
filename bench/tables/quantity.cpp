#include "bench/tables/quantity.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "bench/strategies/catalogue.h"
#include "core/base/number_text.h"
#include "core/base/split.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

// The stage that tests the start, for rows that promise something from an embedded start alone.
constexpr std::string_view kStartTest = "embedding";
// The stage in which the fallback, a complete row, finds which triangles cross at the start.
constexpr std::string_view kStartSeen = "start";

// Why there is no figure.
struct Missing {
  std::string reason;
};

// A figure with its repetitions, or one that has no noise.
struct Amount {
  std::vector<double> samples;
  bool noisy = false;
};

double summary(const std::vector<double>& samples, const std::string& statistic) {
  if (statistic == "mean") return mean(samples);
  if (statistic == "median") return median(samples);
  if (statistic == "min") return std::ranges::min(samples);
  if (statistic == "max") return std::ranges::max(samples);
  throw std::logic_error("unknown statistic " + statistic);
}

const StrategyRecord& strategy_of(const Record& record, const std::string& name) {
  if (const StrategyRecord* strategy = record.strategy(name)) return *strategy;
  const auto rows = strategies();
  const bool built = std::ranges::any_of(rows, [&](const Strategy& row) { return row.name == name; });
  throw Missing{name + (built ? ": not run in this record" : ": not in this build")};
}

Amount exactly(double value) {
  return {{value}, false};
}

Amount scene_amount(const SceneRecord& scene, const std::string& what) {
  if (what == "triangles") return exactly(static_cast<double>(scene.triangles));
  if (what == "vertices") return exactly(static_cast<double>(scene.vertices));
  if (what == "bones") return exactly(static_cast<double>(scene.bones));
  throw std::logic_error("unknown scene quantity " + what);
}

Amount preparation_amount(const StrategyRecord& strategy, const std::string& what) {
  const PreparationRecord& preparation = strategy.preparation;
  if (what == "atomic_clusters") {
    if (!preparation.atomic_clusters) throw Missing{strategy.name + ": has no clusters"};
    return exactly(*preparation.atomic_clusters);
  }
  const std::vector<double>& samples =
      what == "distance_and_heat_ms" ? preparation.distance_and_heat_ms : preparation.decomposition_ms;
  if (samples.empty()) throw Missing{strategy.name + ": has no such preparation"};
  return {samples, true};
}

Amount footprint_amount(const StrategyRecord& strategy, const std::string& what) {
  const auto figure = [&](const auto& value, const char* whose) {
    if (!value) throw Missing{std::string("this ") + whose + " does not count them"};
    return exactly(static_cast<double>(*value));
  };
  if (what == "peak_bytes") return figure(strategy.footprint.peak_bytes, "kernel");
  if (what == "held_bytes") return figure(strategy.footprint.held_bytes, "kernel");
  if (what == "instructions") return figure(strategy.footprint.instructions, "machine");
  throw std::logic_error("unknown footprint " + what);
}

Amount count_amount(const StrategyRecord& strategy, const std::string& counters,
                    const std::string& statistic) {
  std::vector<double> sums;
  for (const std::string& counter : split(counters, '+')) {
    const auto column = strategy.counts.find(counter);
    if (column == strategy.counts.end()) throw Missing{strategy.name + ": does not count " + counter};
    sums.resize(column->second.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += static_cast<double>(column->second[i]);
  }
  return exactly(summary(sums, statistic));
}

// One number a repetition. A stage that the strategy does not have takes no time, but all of them cannot be
// missing.
Amount time_amount(const StrategyRecord& strategy, const std::string& stages, const std::string& statistic) {
  std::vector<std::vector<double>> sums;
  std::vector<std::string> parts = split(stages, '+');
  if (const auto query = std::ranges::find(parts, "query"); query != parts.end()) {
    parts.erase(query);
    parts.insert(parts.begin(), kQueryStages.begin(), kQueryStages.end());
  }
  for (const std::string& stage : parts) {
    const auto column = strategy.ms.find(stage);
    if (column == strategy.ms.end() && stage == kStartTest && needs_embedded_start(strategy.guarantee))
      throw Missing{"this record does not have the time of the test of the start"};
    if (column == strategy.ms.end() && stage == kStartSeen && strategy.name == complete_fallback().name)
      throw Missing{"this record does not have the time of looking at the start"};
    if (column == strategy.ms.end()) continue;
    if (sums.empty()) sums.assign(column->second.size(), std::vector<double>(column->second.front().size()));
    for (std::size_t r = 0; r < sums.size(); ++r)
      for (std::size_t i = 0; i < sums[r].size(); ++i) sums[r][i] += column->second[r][i];
  }
  if (sums.empty() && stages == kStartTest) throw Missing{strategy.name + ": needs no test of the start"};
  if (sums.empty()) throw Missing{strategy.name + ": has no stage " + stages};
  Amount amount{{}, true};
  for (const std::vector<double>& repetition : sums) amount.samples.push_back(summary(repetition, statistic));
  return amount;
}

Amount verification_amount(const VerificationRecord& verification, const std::string& strategy,
                           const std::string& what) {
  const VerifiedStrategy* row = verification.strategy(strategy);
  if (row == nullptr) throw Missing{strategy + ": not verified in this record"};
  if (row->contacts_expected == 0) throw Missing{"no contact on the verified intervals"};
  if (what == "recall")
    return exactly(static_cast<double>(row->contacts_found) / static_cast<double>(row->contacts_expected));
  if (what == "first_contacts") return exactly(static_cast<double>(row->intervals_promised));
  throw std::logic_error("unknown verification quantity " + what);
}

Amount truth_amount(const VerificationRecord& verification, const std::string& what) {
  if (!verification.truth) throw Missing{"not held against truth from outside"};
  const TruthRecord& truth = *verification.truth;
  if (what == "contacts") return exactly(static_cast<double>(truth.contacts));
  if (what == "missed") return exactly(static_cast<double>(truth.missed));
  if (what == "invented") return exactly(static_cast<double>(truth.invented));
  throw std::logic_error("unknown quantity of truth " + what);
}

Amount amount_of(const Record& record, const std::string& quantity, const std::string& strategy,
                 const std::string& statistic) {
  const std::size_t dot = quantity.find('.');
  const std::string kind = quantity.substr(0, dot), what = quantity.substr(dot + 1);
  if (kind == "scene") return scene_amount(record.scene, what);
  if (kind == "truth") return truth_amount(record.verification, what);
  if (kind == "verification") return verification_amount(record.verification, strategy, what);
  const StrategyRecord& row = strategy_of(record, strategy);
  if (kind == "preparation") return preparation_amount(row, what);
  if (kind == "footprint") return footprint_amount(row, what);
  if (kind == "counts") return count_amount(row, what, statistic);
  if (kind == "ms") return time_amount(row, what, statistic);
  throw std::logic_error("unknown quantity " + quantity);
}

Measured measured(const Amount& amount, double scale) {
  if (!amount.noisy) return {amount.samples.front() * scale, {}, {}};
  const Estimate estimate = bootstrap_median(amount.samples);
  return {estimate.value * scale,
          Estimate{estimate.value * scale, estimate.low * scale, estimate.high * scale},
          {}};
}

Measured ratio(const Amount& amount, const Amount& divisor, const std::string& divisor_name) {
  if (amount.noisy != divisor.noisy || amount.samples.size() != divisor.samples.size())
    throw std::logic_error("a ratio of what is measured in different ways");
  if (median(divisor.samples) == 0) throw Missing{divisor_name + " is zero"};
  if (!amount.noisy) return {amount.samples.front() / divisor.samples.front(), {}, {}};
  const Estimate estimate = bootstrap_ratio_of_medians(amount.samples, divisor.samples);
  return {estimate.value, estimate, {}};
}

Measured best_of_baselines(ordered_json definition, const Record& record) {
  Measured best = {{}, {}, "no complete baseline was run"};
  for (const StrategyRecord& row : record.strategies) {
    if (row.guarantee != to_string(Guarantee::complete) || row.name.starts_with("drvbc_fast") ||
        row.name.ends_with(" --first"))
      continue;
    definition["strategy"] = row.name;
    const Measured one = measure(definition, record);
    if (!one.value || (best.value && *best.value <= *one.value)) continue;
    best = one;
    best.of = row.name;
  }
  return best;
}

}  // namespace

Measured measure(const ordered_json& definition, const Record& record) {
  if (definition.value("strategy", "") == kBestBaseline) return best_of_baselines(definition, record);
  const std::string quantity = definition.at("quantity"), strategy = definition.value("strategy", ""),
                    statistic = definition.value("statistic", "mean"),
                    over = definition.value("over", strategy);
  try {
    const Amount amount = amount_of(record, quantity, strategy, statistic);
    const bool is_ratio = definition.contains("over") || definition.contains("over_quantity");
    const std::string over_quantity = definition.value("over_quantity", quantity);
    Measured out = is_ratio ? ratio(amount, amount_of(record, over_quantity, over, statistic),
                                    over + ": " + over_quantity)
                            : measured(amount, definition.value("scale", 1.0));
    out.marked = quantity.starts_with("ms.") && (shortfall(record, strategy) || shortfall(record, over));
    return out;
  } catch (const Missing& missing) {
    return {{}, {}, missing.reason};
  }
}

Measured median_query(const std::string& strategy, const Record& record, const std::string& over) {
  ordered_json definition = {{"quantity", "ms.query"}, {"strategy", strategy}, {"statistic", "median"}};
  if (!over.empty()) definition["over"] = over;
  return measure(definition, record);
}

std::string text_of(const Measured& figure, bool with_interval) {
  if (!figure.value) return "";
  std::string out = figure_text(*figure.value);
  if (with_interval && figure.interval)
    out += " [" + figure_text(figure.interval->low) + ", " + figure_text(figure.interval->high) + "]";
  if (figure.marked) out += kShortfallMark;
  return out + (figure.of.empty() ? "" : ", `" + figure.of + "`");
}

Measured measure_over(const ordered_json& definition, const Record& record, const Record& divisor) {
  const Measured amount = measure(definition, record), by = measure(definition, divisor);
  if (!amount.value) return {{}, {}, amount.reason};
  if (!by.value || *by.value == 0) return {{}, {}, by.value ? "the divisor is zero" : by.reason};
  Measured ratio{*amount.value / *by.value, {}, {}};
  ratio.marked = amount.marked || by.marked;
  return ratio;
}

}  // namespace cscd::bench
