#include "bench/scale_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "bench/catalogue.h"
#include "bench/footprint.h"
#include "bench/record.h"
#include "bench/scaling.h"
#include "bench/statistics.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/detect/embedding.h"
#include "core/detect/verify.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// Right in every case, so that what is judged is what is timed.
constexpr char kElementary[] = "filtered_exact";
// What takes longer, in milliseconds, is not repeated; what takes much longer is not asked for a longer step,
// and the reference is asked one interval of it alone.
constexpr double kOnce = 300, kTooLong = 2000;
constexpr const char* kStages[] = {"refit", "rv_update", "traversal", "elementary"};

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// Frames between which a step from one frame lies.
std::size_t last_frame(std::size_t start, double step) {
  return start + static_cast<std::size_t>(std::ceil(step));
}

// A subject's surface on its intervals: those of its first step, then those of the next.
struct Scaled {
  Input input;
  double build_ms;
};

Scaled scaled_input(const PosedScene& posed, const ScaleSubject& subject) {
  const auto begin = Clock::now();
  const scenes::Scene& scene = posed.scene;
  scenes::Shape shape =
      scenes::resized_shape(scene, subject.triangles > 0 ? subject.triangles : scene.expected.triangles);
  const auto bones_of = [&](const std::vector<Bone>& bones) {
    return subject.bones > 0 ? resampled_chain(bones, subject.bones) : bones;
  };
  if (subject.bones > 0 && !is_chain(shape.rig))
    throw InputError("scene " + scene.name + ": its bones form no chain; vary the bones of another scene");

  std::vector<Moment> moments;
  std::vector<MomentSource::Pair> intervals;
  std::map<std::size_t, std::size_t> moment_at;  // by frame
  const auto moment = [&](std::size_t frame) {
    const auto [place, added] = moment_at.try_emplace(frame, moments.size());
    if (added) {
      const auto pose = std::ranges::find(posed.poses, frame, &scenes::Pose::frame);
      moments.push_back({scenes::carried(scene, shape, *pose), bones_of(pose->bones)});
    }
    return place->second;
  };
  for (const double step : subject.steps)
    for (const std::size_t start : subject.starts) {
      const std::size_t first = moment(start);
      std::size_t last = moment(last_frame(start, step));
      if (step < 1) {
        moments.push_back(between(moments[first], moments[last], step));
        last = moments.size() - 1;
      }
      intervals.push_back({first, last});
    }

  Rig rig{shape.rig.parent, bones_of(shape.rig.reference)};
  if (subject.bones > 0) {
    rig.parent.clear();
    for (std::size_t i = 0; i < subject.bones; ++i) rig.parent.push_back(BoneId{static_cast<int>(i) - 1});
  }
  TriangleMesh mesh(shape.triangles, shape.positions.size(), scene.name);
  auto clip = std::make_unique<MomentSource>(
      scenes::ClipHeader{std::move(shape.triangles), shape.positions.size(), rig.parent, false},
      std::move(moments), std::move(intervals));
  Input input{scene.name, std::move(clip), std::move(mesh), std::move(shape.positions), std::move(rig)};
  input.threads = subject.threads;
  return {std::move(input), milliseconds_since(begin)};
}

struct Contestant {
  const Strategy* strategy;
  Made made;
  bool reference;
  // By step: one interval's counters a place, and [repetition][interval] of every stage.
  std::vector<CountColumns> counts;
  std::vector<TimeColumns> ms, once;  // repeated; while it was verified
  // Of each interval; empty where it did not answer it.
  std::vector<std::string> digests;
};

Report answer(Contestant& contestant, const scenes::ClipInterval& interval, ContactSet& found) {
  const Report report = contestant.made.prepared.detector->detect(
      interval.motion, interval.bones ? &*interval.bones : nullptr, found);
  found.sort();
  return report;
}

// What became of the intervals of one step.
struct Verified {
  std::size_t embedded = 0, colliding = 0, by_reference = 0;
  std::vector<ordered_json> first;  // time of the first contact of each interval, null without one
  std::vector<std::string> failures;
};

ordered_json first_time(const ContactSet& sorted) {
  return sorted.contacts.empty() ? ordered_json() : ordered_json(sorted.contacts.front().time);
}

class Measurement {
 public:
  Measurement(const PosedScene& posed, const ScaleSubject& subject)
      : subject_(subject), scaled_(scaled_input(posed, subject)) {
    const ElementaryTest& test = elementary_test_named(kElementary);
    std::vector<const Strategy*> strategies = subject.strategies;
    if (std::ranges::find(strategies, &complete_reference()) == strategies.end())
      strategies.push_back(&complete_reference());
    for (const Strategy* strategy : strategies) {
      if (!allows(input(), *strategy)) continue;
      contestants_.push_back(
          {strategy, make(*strategy, test), strategy == &complete_reference(), {}, {}, {}, {}});
    }
    for (Contestant& c : contestants_) {
      c.counts.resize(subject.steps.size());
      c.ms.resize(subject.steps.size());
      c.once.resize(subject.steps.size());
      c.digests.resize(interval_count());
    }
    verified_.resize(subject.steps.size());
  }

  // Every strategy answers every interval, the reference where it takes part.
  void verify() {
    EmbeddingTest embedding(input().mesh, input().reference);
    std::map<std::size_t, bool> embedded;  // by start: steps share them
    ContactSet truth, found;
    for (std::size_t i = 0; i < interval_count(); ++i) {
      Verified& verified = verified_[step_of(i)];
      const scenes::ClipInterval interval = input().clip->load(i);
      const auto [start, fresh] = embedded.try_emplace(i % subject_.starts.size(), false);
      if (fresh) start->second = embedding.embedded(interval.motion.start());
      verified.embedded += start->second;

      const bool judged = reference_answers(i);
      if (judged) {
        Contestant& reference = *std::ranges::find_if(contestants_, &Contestant::reference);
        keep(reference, i, answer(reference, interval, truth), truth);
        ++verified.by_reference;
      }
      ordered_json first = judged ? first_time(truth) : ordered_json();
      const Contestant* told = nullptr;  // who told the first contact where the reference did not
      for (Contestant& c : contestants_) {
        if (c.reference || left_out(c, step_of(i))) continue;
        keep(c, i, answer(c, interval, found), found);
        const std::string where = std::string(c.strategy->name) + ", interval " + std::to_string(i) + ": ";
        if (judged) {
          const Verification judgement = cscd::verify(truth, found, c.strategy->guarantee, start->second);
          if (!judgement.ok) verified.failures.push_back(where + judgement.failure);
        } else if (!told) {
          first = first_time(found);
          told = &c;
        } else if (start->second && first != first_time(found)) {
          verified.failures.push_back(where + "another first contact than " +
                                      std::string(told->strategy->name));
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
        std::vector<Contestant*> order;
        for (Contestant& c : contestants_)
          if (is_timed(c) && !c.digests[i].empty() && once_ms(c, step_of(i)) <= kOnce) order.push_back(&c);
        for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
        for (Contestant* c : order) {
          stream_positions(interval.motion);
          const Report report = answer(*c, interval, found);
          append_times(report.ms, c->ms[step_of(i)], repetition);
          if (digest(found) != c->digests[i]) {
            verified_[step_of(i)].failures.push_back(std::string(c->strategy->name) + ", interval " +
                                                     std::to_string(i) + ": other contacts when timed");
            break;
          }
        }
      }
  }

  bool ok() const {
    return std::ranges::all_of(verified_, [](const Verified& v) { return v.failures.empty(); });
  }

  ordered_json json(const std::string& scene) const {
    ordered_json strategies = ordered_json::array(), steps = ordered_json::array();
    for (const Contestant& c : contestants_)
      if (is_timed(c)) strategies.push_back(preparation_json(c));
    for (std::size_t s = 0; s < subject_.steps.size(); ++s) steps.push_back(step_json(s));
    return {{"study", subject_.study},
            {"scene", scene},
            {"triangles", input().mesh.triangle_count()},
            {"vertices", input().mesh.vertex_count()},
            {"bones", input().rig->parent.size()},
            {"threads", subject_.threads},
            {"build_ms", scaled_.build_ms},
            {"ok", ok()},
            {"strategies", std::move(strategies)},
            {"steps", std::move(steps)}};
  }

 private:
  Input& input() { return scaled_.input; }
  const Input& input() const { return scaled_.input; }
  std::size_t interval_count() const { return subject_.steps.size() * subject_.starts.size(); }
  std::size_t step_of(std::size_t interval) const { return interval / subject_.starts.size(); }
  bool is_timed(const Contestant& c) const {
    return std::ranges::find(subject_.strategies, c.strategy) != subject_.strategies.end();
  }
  // Milliseconds of a query as it was verified, mean over a step's intervals; 0 if it answered none.
  double once_ms(const Contestant& c, std::size_t s) const {
    double sum = 0;
    for (const auto& [stage, repetitions] : c.once[s]) sum += mean(repetitions.front());
    return sum;
  }
  // Steps come in order of their length.
  bool left_out(const Contestant& c, std::size_t s) const {
    for (std::size_t shorter = 0; shorter < s; ++shorter)
      if (once_ms(c, shorter) > kTooLong) return true;
    return false;
  }
  // All intervals of small surfaces and short steps; else the first of a step, and those that fewer than two
  // others answer.
  bool reference_answers(std::size_t interval) const {
    const std::size_t s = step_of(interval);
    std::size_t others = 0;
    for (const Contestant& c : contestants_) {
      if (!c.reference)
        others += !left_out(c, s);
      else if (input().mesh.triangle_count() <= subject_.reference_limit && !left_out(c, s))
        return true;
    }
    return interval % subject_.starts.size() == 0 || others < 2;
  }

  // Measuring memory takes two answers, too many of the reference on a large surface.
  Made make(const Strategy& strategy, const ElementaryTest& test) {
    if (&strategy != &complete_reference() || input().mesh.triangle_count() <= subject_.reference_limit)
      return make_measured(input(), strategy, test, 0);
    const auto begin = Clock::now();
    Made made{strategy.make(input().setup(test)), {}};
    made.make_ms = milliseconds_since(begin);
    return made;
  }

  void keep(Contestant& c, std::size_t interval, const Report& report, const ContactSet& sorted) {
    append_counts(report, sorted, c.counts[step_of(interval)]);
    append_times(report.ms, c.once[step_of(interval)], 0);
    c.digests[interval] = digest(sorted);
  }

  ordered_json preparation_json(const Contestant& c) const {
    ordered_json out = {{"name", c.strategy->name},
                        {"guarantee", to_string(c.strategy->guarantee)},
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
    for (const Contestant& c : contestants_)
      if (is_timed(c)) rows.push_back(row_json(c, s));
    return {{"step", subject_.steps[s]},
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
  }

  ordered_json row_json(const Contestant& c, std::size_t s) const {
    ordered_json row = {{"name", c.strategy->name}};
    ordered_json means = ordered_json::object();
    for (const auto& [name, values] : c.counts[s])
      means[name] = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    row["intervals"] = c.counts[s].empty() ? 0 : c.counts[s].begin()->second.size();
    row["counts"] = std::move(means);
    if (!verified_[s].failures.empty()) return row;  // no time without a verified answer
    const TimeColumns& columns = c.ms[s].empty() ? c.once[s] : c.ms[s];
    if (columns.empty()) {
      row["left_out"] = "takes over " + std::to_string(static_cast<int>(kTooLong)) + " ms for a shorter step";
      return row;
    }
    ordered_json ms = ordered_json::object();
    std::vector<double> total(columns.begin()->second.size(), 0);
    for (const char* stage : kStages) {
      const auto column = columns.find(stage);
      if (column == columns.end()) continue;
      std::vector<double> samples;
      for (const std::vector<double>& repetition : column->second) samples.push_back(mean(repetition));
      for (std::size_t r = 0; r < samples.size(); ++r) total[r] += samples[r];
      ms[stage] = median(samples);
    }
    ms["total"] = median(total);
    row["ms"] = std::move(ms);
    row["total_samples"] = total;
    return row;
  }

  const ScaleSubject& subject_;
  Scaled scaled_;
  std::vector<Contestant> contestants_;
  std::vector<Verified> verified_;  // by step
};

}  // namespace

std::vector<std::size_t> spread_starts(std::size_t frames, std::size_t count, double longest_step) {
  const std::size_t reach = last_frame(0, longest_step);
  if (frames < reach + 1 + count)
    throw InputError("a step of " + std::to_string(reach) + " frames from " + std::to_string(count) +
                     " places does not fit into " + std::to_string(frames) +
                     " frames; take shorter steps or fewer intervals");
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < count; ++i) starts.push_back((2 * i + 1) * (frames - 1 - reach) / (2 * count));
  return starts;
}

PosedScene pose_scene(const std::string& name, std::span<const double> steps,
                      std::span<const std::size_t> starts) {
  PosedScene posed{scenes::load_scene(name), {}};
  std::set<std::size_t> frames;
  for (const std::size_t start : starts) {
    frames.insert(start);
    for (const double step : steps) frames.insert(last_frame(start, step));
  }
  posed.poses = scenes::poses_at(posed.scene, std::vector<std::size_t>(frames.begin(), frames.end()));
  return posed;
}

ordered_json measure_subject(const PosedScene& posed, const ScaleSubject& subject, std::mt19937_64& random) {
  Measurement measurement(posed, subject);
  measurement.verify();
  measurement.time(random);
  return measurement.json(posed.scene.name);
}

}  // namespace cscd::bench
