#include "bench/measure/studies/scale_study.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

#include "bench/harness/footprint.h"
#include "bench/harness/timing.h"
#include "bench/records/record.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/strategy_row.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/detect/start/embedding.h"
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
constexpr const char* kStages[] = {"refit", "rv_update", "traversal", "elementary"};

struct Entrant {
  StrategyRow row;
  Made made;
  bool reference;
  // By step: one interval's counters a place, and [repetition][interval] of every stage.
  std::vector<CountColumns> counts;
  std::vector<TimeColumns> ms, once;  // repeated; while it was verified
  // By step: what the answers lack on the intervals that the reference answered too.
  std::vector<Shortfall> lacking;
  // By interval: what the strategy promises of its contacts, empty where it did not answer.
  std::vector<std::string> promised;
};

Report answer(Entrant& entrant, const Step& step, ContactSet& found) {
  const Report report = entrant.made.prepared.detector->detect(step, found);
  found.sort();
  if (entrant.row.first) keep_first(found);
  return report;
}

// The outcome of the verification of one step's intervals.
struct Verified {
  std::size_t embedded = 0, colliding = 0, by_reference = 0;
  std::size_t clear = 0;            // embedded, and with a thickness, nothing is close
  std::vector<ordered_json> first;  // time of the first contact of each interval, null without one
  std::vector<std::string> failures;
};

ordered_json first_time(const ContactSet& sorted) {
  return sorted.contacts.empty() ? ordered_json() : ordered_json(sorted.contacts.front().time);
}

class Measurement {
 public:
  explicit Measurement(const ScaleSubject& subject)
      : subject_(subject),
        scaled_(scale_input(subject)),
        edge_(mean_edge(input().mesh, input().rest())),
        is_thick_(std::ranges::any_of(subject.steps, [](const ScaleStep& s) { return s.edges > 0; })) {
    const ElementaryTest& test = elementary_test_named(kElementary);
    std::vector<StrategyRow> rows = subject.rows;
    const StrategyRow reference{&complete_reference()};
    if (std::ranges::find(rows, reference) == rows.end()) rows.push_back(reference);
    for (const StrategyRow& row : rows) {
      if (const auto why = why_not(*row.strategy, input().mesh, input().rig.has_value())) {
        left_out_.push_back({{"name", row.name()}, {"why", *why}});
        continue;
      }
      entrants_.push_back({row, make(row, test), row == reference, {}, {}, {}, {}, {}});
    }
    for (Entrant& c : entrants_) {
      c.counts.resize(subject.steps.size());
      c.ms.resize(subject.steps.size());
      c.once.resize(subject.steps.size());
      c.lacking.resize(subject.steps.size());
      c.promised.resize(interval_count());
    }
    verified_.resize(subject.steps.size());
    embedded_.resize(interval_count());
  }

  // Every strategy answers every interval, the reference where it takes part.
  void verify() {
    EmbeddingTest embedding(input().mesh, input().reference);
    std::map<std::pair<std::string, std::size_t>, bool> embedded;  // by scene and start: steps share them
    ContactSet truth, found;
    for (std::size_t i = 0; i < interval_count(); ++i) {
      Verified& verified = verified_[step_of(i)];
      const scenes::ClipInterval interval = input().clip->load(i);
      const auto [start, fresh] =
          embedded.try_emplace({subject_.steps[step_of(i)].scene, start_of(i)}, false);
      if (fresh) start->second = embedding.embedded(interval.motion.start());
      bool promise_holds = start->second;
      embedded_[i] = promise_holds;
      verified.embedded += start->second;

      const bool judged = reference_answers(i);
      if (judged) {
        Entrant& reference = *std::ranges::find_if(entrants_, &Entrant::reference);
        const Report report = answer(reference, asked(interval, i), truth);
        // With a thickness, promises are about clear starts.
        if (length_of(i) > 0 && first_time(truth) == 0.0) promise_holds = false;
        embedded_[i] = promise_holds;
        verified.clear += promise_holds;
        keep(reference, i, report, truth);
        ++verified.by_reference;
      }
      ordered_json first = judged ? first_time(truth) : ordered_json();
      const Entrant* told = nullptr;  // who told the first contact where the reference did not
      for (Entrant& c : entrants_) {
        if (c.reference || left_out(c, step_of(i))) continue;
        keep(c, i, answer(c, asked(interval, i), found), found);
        const std::string where = label(c, i);
        if (judged) {
          compare_with(truth, found, promise_holds, c, c.lacking[step_of(i)]);
          const Verification judgement = bench::verify(truth, found, c.row, promise_holds);
          if (!judgement.ok) verified.failures.push_back(where + judgement.failure);
        } else if (!told) {
          first = first_time(found);
          told = &c;
        } else if (start->second && first != first_time(found)) {
          verified.failures.push_back(where + "another first contact than " + told->row.name());
        }
      }
      verified.colliding += !first.is_null();
      verified.first.push_back(std::move(first));
    }
  }

  // Interval by interval, in an order drawn anew. Who answered some intervals only has the times of those.
  void time(std::mt19937_64& random) {
    ContactSet found;
    for (std::size_t repetition = 0; repetition < subject_.repetitions; ++repetition)
      for (std::size_t i = 0; i < interval_count(); ++i) {
        if (!verified_[step_of(i)].failures.empty()) continue;
        const scenes::ClipInterval interval = input().clip->load(i);
        std::vector<Entrant*> order;
        for (Entrant& c : entrants_)
          if (is_timed(c) && !c.promised[i].empty() && once_ms(c, step_of(i)) <= kOnce) order.push_back(&c);
        shuffle(order, random);
        for (Entrant* c : order) {
          stream_positions(interval.motion);
          const Report report = answer(*c, asked(interval, i), found);
          append_times(report.ms, c->ms[step_of(i)], repetition);
          if (promised(*c, i, found) != c->promised[i]) {
            verified_[step_of(i)].failures.push_back(label(*c, i) + "other contacts when timed");
            break;
          }
        }
      }
  }

  bool ok() const {
    return std::ranges::all_of(verified_, [](const Verified& v) { return v.failures.empty(); });
  }

  ordered_json json() const {
    ordered_json strategies = ordered_json::array(), steps = ordered_json::array();
    for (const Entrant& c : entrants_)
      if (is_timed(c)) strategies.push_back(preparation_json(c));
    for (std::size_t s = 0; s < subject_.steps.size(); ++s) steps.push_back(step_json(s));
    return {{"study", subject_.study},
            {"scene", scenes::plain_name(subject_.scene)},
            {"triangles", input().mesh.triangle_count()},
            {"vertices", input().mesh.vertex_count()},
            {"bones", input().rig ? input().rig->parent.size() : 0},
            {"threads", subject_.threads},
            {"build_ms", scaled_.build_ms},
            {"ok", ok()},
            {"strategies", std::move(strategies)},
            {"left_out", left_out_},
            {"steps", std::move(steps)}};
  }

 private:
  Input& input() { return scaled_.input; }
  const Input& input() const { return scaled_.input; }
  std::size_t interval_count() const { return subject_.steps.size() * subject_.starts.size(); }
  std::size_t step_of(std::size_t interval) const { return interval / subject_.starts.size(); }
  std::size_t start_of(std::size_t interval) const {
    return subject_.starts[interval % subject_.starts.size()];
  }
  // The thickness of an interval.
  double length_of(std::size_t interval) const { return subject_.steps[step_of(interval)].edges * edge_; }
  Step asked(const scenes::ClipInterval& interval, std::size_t number) const {
    Step step = input().step(interval);
    step.thickness = Thickness(length_of(number));
    return step;
  }
  // Begins the line of a failure, under the step that it belongs to.
  std::string label(const Entrant& c, std::size_t interval) const {
    return c.row.name() + ", from frame " + std::to_string(start_of(interval)) + ": ";
  }
  // Counts what an answer lacks of the reference's. A row that is asked for the first contact lacks nothing
  // but that one.
  static void compare_with(const ContactSet& truth, const ContactSet& found, bool promise_holds,
                           const Entrant& c, Shortfall& out) {
    const std::size_t all = truth.contacts.size();
    out.contacts_expected += c.row.first ? std::min<std::size_t>(all, 1) : all;
    out.contacts_found += found.contacts.size();
    ++out.intervals;
    out.void_intervals +=
        !promise_holds && needs_embedded_start(std::string(to_string(c.row.strategy->guarantee)));
  }
  bool is_timed(const Entrant& c) const {
    return std::ranges::find(subject_.rows, c.row) != subject_.rows.end();
  }
  // Milliseconds of a query as it was verified, mean over a step's intervals; 0 if it answered none.
  double once_ms(const Entrant& c, std::size_t s) const {
    double sum = 0;
    for (const auto& [stage, repetitions] : c.once[s]) sum += mean(repetitions.front());
    return sum;
  }
  // By what it took for an earlier step, which is no longer than this one.
  bool left_out(const Entrant& c, std::size_t s) const {
    for (std::size_t earlier = 0; earlier < s; ++earlier)
      if (once_ms(c, earlier) > kTooLong) return true;
    return false;
  }
  // All intervals of small surfaces and short steps; else the first of a step, and those that fewer than two
  // others answer.
  bool reference_answers(std::size_t interval) const {
    const std::size_t s = step_of(interval);
    std::size_t others = 0;
    for (const Entrant& c : entrants_) {
      if (!c.reference)
        others += !left_out(c, s);
      else if (input().mesh.triangle_count() <= subject_.reference_limit && !left_out(c, s))
        return true;
    }
    // What is close at the start, the reference alone says for sure.
    if (is_thick_) return true;
    return interval % subject_.starts.size() == 0 || others < 2;
  }

  // Measuring memory takes two answers, too many of the reference on a large surface.
  Made make(const StrategyRow& row, const ElementaryTest& test) {
    if (row.strategy != &complete_reference() || input().mesh.triangle_count() <= subject_.reference_limit)
      return make_measured(input(), row, test, 0);
    const Stopwatch making;
    Made made{row.strategy->make(
                  setup_for(*row.strategy, input().setup(test, row.first), input().clip->interval_count())),
              {}};
    made.make_ms = making.milliseconds();
    return made;
  }

  // What a strategy promises of these contacts. What else it reports may depend on the intervals that it has
  // answered before, where its covers follow the surface.
  std::string promised(const Entrant& c, std::size_t interval, const ContactSet& sorted) const {
    const Guarantee guarantee = c.row.strategy->guarantee;
    if (needs_embedded_start(guarantee) && !embedded_[interval]) return "nothing";
    return guarantee == Guarantee::first_contact ? first_time(sorted).dump() : digest(sorted);
  }

  void keep(Entrant& c, std::size_t interval, const Report& report, const ContactSet& sorted) {
    append_counts(report, sorted, c.counts[step_of(interval)]);
    append_times(report.ms, c.once[step_of(interval)], 0);
    c.promised[interval] = promised(c, interval, sorted);
  }

  ordered_json preparation_json(const Entrant& c) const {
    ordered_json out = {{"name", c.row.name()},
                        {"guarantee", to_string(c.row.strategy->guarantee)},
                        {"threads", c.made.prepared.preparation.threads},
                        {"make_ms", c.made.make_ms}};
    const Preparation& preparation = c.made.prepared.preparation;
    if (preparation.distance_and_heat_ms) out["distance_and_heat_ms"] = *preparation.distance_and_heat_ms;
    if (preparation.decomposition_ms) out["decomposition_ms"] = *preparation.decomposition_ms;
    if (!preparation.atomic_cluster.empty()) out["atomic_clusters"] = preparation.atomic_clusters;
    const auto add = [&](const char* name, const std::optional<std::uint64_t>& bytes) {
      if (!bytes) return;
      out[std::string(name) + "_bytes"] = *bytes;
      out[std::string(name) + "_bytes_per_triangle"] =
          static_cast<double>(*bytes) / static_cast<double>(input().mesh.triangle_count());
    };
    add("peak", c.made.footprint.peak_bytes);
    add("held", c.made.footprint.held_bytes);
    return out;
  }

  ordered_json step_json(std::size_t s) const {
    const Verified& verified = verified_[s];
    ordered_json rows = ordered_json::array();
    for (const Entrant& c : entrants_)
      if (is_timed(c)) rows.push_back(row_json(c, s));
    ordered_json out = {{"step", subject_.steps[s].frames},
                        {"scene", scenes::plain_name(subject_.steps[s].scene)},
                        {"starts", subject_.starts},
                        {"embedded", verified.embedded},
                        {"colliding", verified.colliding},
                        {"first_contact", verified.first},
                        {"verified",
                         {{"ok", verified.failures.empty()},
                          {"by_reference", verified.by_reference},
                          {"by_each_other", subject_.starts.size() - verified.by_reference},
                          {"failures", verified.failures}}},
                        {"strategies", std::move(rows)}};
    if (is_thick_) {
      out["thickness"] = subject_.steps[s].edges;
      out["length"] = subject_.steps[s].edges * edge_;
      out["clear"] = verified.clear;
    }
    return out;
  }

  ordered_json row_json(const Entrant& c, std::size_t s) const {
    ordered_json row = {{"name", c.row.name()}};
    ordered_json counts = ordered_json::object();
    for (const auto& [name, values] : c.counts[s])
      counts[name] = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    if (const Shortfall& lacking = c.lacking[s]; is_short(lacking))
      row["shortfall"] = shortfall_text(lacking);
    row["intervals"] = c.counts[s].empty() ? 0 : c.counts[s].begin()->second.size();
    row["counts"] = std::move(counts);
    if (!verified_[s].failures.empty()) return row;  // no time without a verified answer
    const TimeColumns& columns = c.ms[s].empty() ? c.once[s] : c.ms[s];
    if (columns.empty()) {
      row["left_out"] =
          "takes over " + std::to_string(static_cast<int>(kTooLong)) + " ms for an earlier step";
      return row;
    }
    ordered_json ms = ordered_json::object();
    std::vector<std::vector<double>> queries(columns.begin()->second.size());  // [repetition][interval]
    for (const char* stage : kStages) {
      const auto column = columns.find(stage);
      if (column == columns.end()) continue;
      std::vector<double> samples;
      for (std::size_t r = 0; r < queries.size(); ++r) {
        const std::vector<double>& times = column->second[r];
        samples.push_back(mean(times));
        queries[r].resize(times.size(), 0);
        std::ranges::transform(queries[r], times, queries[r].begin(), std::plus());
      }
      ms[stage] = median(samples);
    }
    std::vector<double> means, medians;  // of a repetition's intervals
    for (const std::vector<double>& query : queries) {
      means.push_back(mean(query));
      medians.push_back(median(query));
    }
    ms["total"] = median(means);
    ms["median_interval"] = median(medians);
    row["ms"] = std::move(ms);
    row["total_samples"] = means;
    row["median_interval_samples"] = medians;
    return row;
  }

  const ScaleSubject& subject_;
  ScaleInput scaled_;
  double edge_;  // mean length at rest
  bool is_thick_;
  std::vector<Entrant> entrants_;
  ordered_json left_out_ = ordered_json::array();  // rows that the surface does not allow, and why
  std::vector<Verified> verified_;                 // by step
  // By interval: whether its start is embedded, and with a thickness, clear.
  std::vector<bool> embedded_;
};

}  // namespace

ordered_json measure_subject(const ScaleSubject& subject, std::mt19937_64& random) {
  Measurement measurement(subject);
  measurement.verify();
  measurement.time(random);
  return measurement.json();
}

}  // namespace cscd::bench
