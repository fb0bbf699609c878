#include "bench/measure/studies/scale_study.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "bench/harness/measurement.h"
#include "bench/measure/studies/small_steps.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/catalogue.h"
#include "core/mesh/mean_edge.h"
#include "scenes/catalog/plain_name.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

// Right in every case, so that what is judged is what is timed.
constexpr char kElementary[] = "filtered_exact";
// Milliseconds. Queries that take more than kOnce are not repeated. A strategy whose queries take more than
// kTooLong is not asked for longer steps, of which the reference then answers one interval alone.
constexpr double kOnce = 300, kTooLong = 2000;

// A subject as a plan of sections, one a step.
class Study {
 public:
  explicit Study(const ScaleSubject& subject)
      : subject_(subject),
        scaled_(subject.study == "small" ? small_steps_input(subject) : scale_input(subject)),
        edge_(mean_edge(input().mesh, input().rest())),
        is_thick_(std::ranges::any_of(subject.steps, [](const ScaleStep& s) { return s.edges > 0; })) {
    const ElementaryTest& test = elementary_test_named(kElementary);
    for (const StrategyRow& row : subject.rows) {
      if (const auto why = why_not(*row.strategy, input().mesh, input().rig.has_value())) {
        left_out_.push_back({{"name", row.name()}, {"why", *why}});
        continue;
      }
      // A footprint takes two answers, too many of the reference on a large surface.
      const bool is_measured = row.strategy != &complete_reference() || is_small();
      contestants_.push_back(make_contestant(input(), row, test, test,
                                             is_measured ? std::optional<std::size_t>(0) : std::nullopt));
    }
    measurement_.emplace(Measurement::Setup{
        input(), contestants_, test, test, scaled_.leads, [this](std::size_t interval) {
          return "from frame " + std::to_string(subject_.starts[interval % subject_.starts.size()]);
        }});
  }

  void measure(std::mt19937_64& random) {
    for (std::size_t s = 0; s < subject_.steps.size(); ++s)
      results_.push_back(&measurement_->count(section(s)));
    measurement_->time({.repetitions = subject_.repetitions, .random = random, .most_ms = kOnce});
  }

  ordered_json json() {
    ordered_json strategies = ordered_json::array(), steps = ordered_json::array();
    for (const Contestant& c : contestants_) strategies.push_back(preparation_json(c));
    for (std::size_t s = 0; s < subject_.steps.size(); ++s) steps.push_back(step_json(s));
    return {{"study", subject_.study},
            {"scene", scenes::plain_name(subject_.scene)},
            {"triangles", input().mesh.triangle_count()},
            {"vertices", input().mesh.vertex_count()},
            {"bones", input().rig ? input().rig->parent.size() : 0},
            {"threads", subject_.threads},
            {"build_ms", scaled_.build_ms},
            {"ok", std::ranges::all_of(results_, [](const auto* r) { return r->verification.ok(); })},
            {"strategies", std::move(strategies)},
            {"left_out", left_out_},
            {"steps", std::move(steps)}};
  }

 private:
  Input& input() { return scaled_.input; }
  bool is_small() { return input().mesh.triangle_count() <= subject_.reference_limit; }

  // All intervals of a step. The reference judges all of them on small surfaces and in short steps; else the
  // first of the step, or all where fewer than two others answer. With a thickness it judges all, because
  // nobody else can tell for sure what is close at the start.
  Section section(std::size_t s) {
    Section out;
    out.counted.resize(subject_.starts.size());
    std::iota(out.counted.begin(), out.counted.end(), s * subject_.starts.size());
    out.timed = out.counted;
    out.thickness = subject_.steps[s].edges * edge_;
    out.reference_answers_all = false;
    bool all = is_small();
    std::size_t others = 0;
    for (std::size_t c = 0; c < contestants_.size(); ++c) {
      const bool is_reference =
          contestants_[c].row.strategy == &complete_reference() && !contestants_[c].row.first;
      const bool is_slow = std::ranges::any_of(
          results_, [&](const SectionResult* earlier) { return earlier->mean_ms(c) > kTooLong; });
      if (is_reference) all = all && !is_slow;
      const bool is_asked =
          is_reference || (!is_slow && (out.thickness == 0 || contestants_[c].row.strategy->knows_distance));
      out.asked.push_back(is_asked);
      others += !is_reference && is_asked;
    }
    for (const SectionResult* earlier : results_) {  // of a reference that is no row, what judging took
      const VerificationRecord& judged = earlier->verification;
      all = all && 1000 * judged.seconds <= kTooLong * static_cast<double>(judged.intervals.size());
    }
    out.verified = out.counted;
    if (!all && !is_thick_ && others >= 2) out.verified.resize(1);
    return out;
  }

  ordered_json preparation_json(const Contestant& c) {
    ordered_json out = {{"name", c.row.name()},
                        {"guarantee", to_string(c.row.strategy->guarantee)},
                        {"threads", c.threads},
                        {"make_ms", c.make_ms}};
    const PreparationRecord& preparation = c.preparation;
    if (!preparation.distance_and_heat_ms.empty())
      out["distance_and_heat_ms"] = preparation.distance_and_heat_ms.front();
    if (!preparation.decomposition_ms.empty()) out["decomposition_ms"] = preparation.decomposition_ms.front();
    if (preparation.atomic_clusters) out["atomic_clusters"] = *preparation.atomic_clusters;
    const auto add = [&](const char* name, const std::optional<std::uint64_t>& bytes) {
      if (!bytes) return;
      out[std::string(name) + "_bytes"] = *bytes;
      out[std::string(name) + "_bytes_per_triangle"] =
          static_cast<double>(*bytes) / static_cast<double>(input().mesh.triangle_count());
    };
    add("peak", c.footprint.peak_bytes);
    add("held", c.footprint.held_bytes);
    return out;
  }

  ordered_json step_json(std::size_t s) {
    const SectionResult& result = *results_[s];
    const VerificationRecord& verified = result.verification;
    ordered_json rows = ordered_json::array(), first = rows, failures = rows, leads = rows;
    for (std::size_t c = 0; c < contestants_.size(); ++c) {
      rows.push_back(row_json(result, c));
      for (const std::string& failure : verified.strategies[c].failures)
        failures.push_back(result.rows[c].name + ", " + failure);
    }
    for (const std::size_t i : result.section.counted)
      leads.push_back(scaled_.leads[i].last - scaled_.leads[i].first);
    for (const std::optional<double>& time : result.first_times)
      first.push_back(time ? ordered_json(*time) : ordered_json());
    const auto starts = [&](const auto& holds) {
      return std::ranges::count_if(result.section.counted, holds);
    };
    ordered_json out = {
        {"step", subject_.steps[s].frames},
        {"scene", scenes::plain_name(subject_.steps[s].scene)},
        {"starts", subject_.starts},
        {"leads", std::move(leads)},
        {"embedded", starts([&](std::size_t i) { return measurement_->starts_embedded(i); })},
        {"colliding", first.size() - static_cast<std::size_t>(std::ranges::count(first, ordered_json()))},
        {"first_contact", std::move(first)},
        {"verified",
         {{"ok", verified.ok()},
          {"by_reference", verified.intervals.size()},
          {"by_each_other", subject_.starts.size() - verified.intervals.size()},
          {"failures", std::move(failures)}}},
        {"strategies", std::move(rows)}};
    if (subject_.steps[s].moves > 0) {
      out["moves"] = subject_.steps[s].moves;
      out["series"] = subject_.steps[s].series;
    }
    if (is_thick_) {
      out["thickness"] = subject_.steps[s].edges;
      out["length"] = result.section.thickness;
      out["clear"] = verified.intervals.size() - verified.unembedded.size();
    }
    return out;
  }

  ordered_json row_json(const SectionResult& result, std::size_t c) const {
    const StrategyRecord& own = result.rows[c];
    ordered_json row = {{"name", own.name}}, counts = ordered_json::object();
    for (const auto& [name, values] : own.counts)
      counts[name] = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    if (const auto lacking = shortfall(result.verification, result.verification.strategies[c]))
      row["shortfall"] = shortfall_text(*lacking);
    row["intervals"] = own.digests.size();
    row["counts"] = std::move(counts);
    if (!result.verification.ok()) return row;  // no time without a verified answer
    TimeColumns columns = own.ms;
    if (columns.empty())  // not repeated
      for (const std::optional<Counted>& once : result.counted[c])
        if (once) append_times(once->report.ms, columns, 0);
    if (columns.empty()) {
      row["left_out"] =
          result.section.thickness > 0 && !contestants_[c].row.strategy->knows_distance
              ? "has no proof for a thickness"
              : "takes over " + std::to_string(static_cast<int>(kTooLong)) + " ms for an earlier step";
      return row;
    }
    ordered_json ms = ordered_json::object();
    for (const std::string_view stage : kQueryStages)
      if (const auto column = columns.find(std::string(stage)); column != columns.end())
        ms[std::string(stage)] = median(of_repetitions(column->second, mean));
    const auto queries = query_times(columns);
    const std::vector<double> means = of_repetitions(queries, mean),
                              medians = of_repetitions(queries, median);
    ms["total"] = median(means);
    ms["median_interval"] = median(medians);
    if (const auto streaming = columns.find("streaming"); streaming != columns.end())
      row["streaming_ms"] = median(of_repetitions(streaming->second, mean));
    row["ms"] = std::move(ms);
    row["total_samples"] = means;
    row["median_interval_samples"] = medians;
    return row;
  }

  template <class Statistic>
  static std::vector<double> of_repetitions(const std::vector<std::vector<double>>& times,
                                            const Statistic& statistic) {
    std::vector<double> out;
    for (const std::vector<double>& intervals : times) out.push_back(statistic(intervals));
    return out;
  }

  const ScaleSubject& subject_;
  ScaleInput scaled_;
  double edge_;  // mean length at rest
  bool is_thick_;
  std::vector<Contestant> contestants_;
  ordered_json left_out_ = ordered_json::array();  // rows that the surface does not allow, and why
  std::optional<Measurement> measurement_;
  std::vector<SectionResult*> results_;  // [steps]
};

}  // namespace

ordered_json measure_subject(const ScaleSubject& subject, std::mt19937_64& random) {
  Study study(subject);
  study.measure(random);
  return study.json();
}

}  // namespace cscd::bench
