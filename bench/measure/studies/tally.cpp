#include "bench/measure/studies/tally.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/statistics/statistics.h"
#include "core/base/random.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/relative_box.h"
#include "core/geometry/feature_distance.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kDistances = 500;

template <class Use>
auto with_features(const Question& asked, Kind kind, const Use& use) {
  return kind == Kind::vertex_face ? use(as_vertex_face(asked.query)) : use(as_edge_edge(asked.query));
}

// Errors in time by eighths of a decade from 1e-18 on; 0 is smaller than all.
std::size_t bin_of(double error) {
  if (!(error > 1e-18)) return 0;
  return std::min<std::size_t>(255, 1 + static_cast<std::size_t>(8 * (std::log10(error) + 18)));
}
double top_of_bin(std::size_t bin) {
  return bin == 0 ? 0 : std::pow(10.0, static_cast<double>(bin) / 8 - 18);
}

}  // namespace

Truth truth_of(const Question& asked, Kind kind) {
  return with_features(asked, kind, [r = asked.r](const auto& q) -> Truth {
    if ((r == 0 && never_coplanar(q)) || relative_boxes_apart(q, r)) return {{}, Nearness::far};
    const auto contact = r == 0 ? exact::first_contact(q) : exact::first_closeness(q, r);
    return {contact, contact ? Nearness::contact : Nearness::near};
  });
}

Answer ask(const ElementaryTest& test, const Question& asked, Kind kind) {
  return with_features(asked, kind, [&](const auto& q) {
    return asked.r == 0 ? test.answer(q) : test.answer_close(q, asked.r);
  });
}

ExactStage stage_of(const Question& asked, Kind kind) {
  return with_features(asked, kind, [r = asked.r](const auto& q) {
    return r == 0 ? filtered_exact_stage(q) : filtered_exact_close_stage(q, r);
  });
}

double least_distance(const Question& asked, Kind kind) {
  return with_features(asked, kind, [&](const auto& given) {
    const auto q = relative(in_range(given));
    constexpr int samples = 64;
    double best = 0, least = distance_at(q, 0);
    const auto look = [&](double t) {
      const double distance = distance_at(q, t);
      if (distance < least) least = distance, best = t;
    };
    for (int k = 1; k <= samples; ++k) look(static_cast<double>(k) / samples);
    for (double step = 0.5 / samples; step > 1e-12; step /= 2) {
      const double from = best;
      look(std::max(0.0, from - step));
      look(std::min(1.0, from + step));
    }
    const double size = extent(q), r = std::ldexp(asked.r, range_exponent(given));
    return size > 0 ? std::max(0.0, least - r) / size : 0.0;
  });
}

void Tally::count(const Question& asked, Kind kind, const Truth& truth, const Answer& answer) {
  ++queries;
  contacts += truth.contact.has_value();
  if (answer.verdict == Verdict::undecided) ++(truth.contact ? undecided_contacts : undecided_apart);
  if (answer.verdict == Verdict::apart && truth.contact) ++false_negatives;
  if (answer.verdict == Verdict::contact && !truth.contact) {
    ++false_positives;
    if (false_positive_distances.size() < kDistances)
      false_positive_distances.push_back(least_distance(asked, kind));
  }
  if (answer.verdict == Verdict::contact && truth.contact) {
    ++times;
    const double early = truth.contact->lo - answer.time, late = answer.time - truth.contact->hi;
    largest_early = std::max(largest_early, early);
    largest_late = std::max(largest_late, late);
    ++time_errors[bin_of(std::max(early, late))];
  }
}

void Tally::add(const Tally& other) {
  queries += other.queries;
  contacts += other.contacts;
  false_negatives += other.false_negatives;
  false_positives += other.false_positives;
  undecided_contacts += other.undecided_contacts;
  undecided_apart += other.undecided_apart;
  times += other.times;
  largest_early = std::max(largest_early, other.largest_early);
  largest_late = std::max(largest_late, other.largest_late);
  for (std::size_t i = 0; i < time_errors.size(); ++i) time_errors[i] += other.time_errors[i];
  false_positive_distances.insert(false_positive_distances.end(), other.false_positive_distances.begin(),
                                  other.false_positive_distances.end());
  for (std::size_t k = 0; k < ns.size(); ++k) {
    ns[k].insert(ns[k].end(), other.ns[k].begin(), other.ns[k].end());
    timed[k] += other.timed[k];
  }
}

bool Tally::breaks(const ElementaryTest& test) const {
  return (test.apart_is_proof && (false_negatives > 0 || largest_late > 0)) ||
         (test.contact_is_proof && false_positives > 0);
}

nlohmann::ordered_json Tally::json() const {
  nlohmann::ordered_json out = {{"queries", queries},
                                {"contacts", contacts},
                                {"false_negatives", false_negatives},
                                {"false_positives", false_positives},
                                {"undecided_contacts", undecided_contacts},
                                {"undecided_apart", undecided_apart}};
  if (!false_positive_distances.empty())
    out["false_positive_distance"] = {{"median", median(false_positive_distances)},
                                      {"largest", quantile(false_positive_distances, 1)}};
  if (times > 0) {
    std::uint64_t left = times - times / 100, seen = 0;
    std::size_t bin = 0;
    for (; bin < time_errors.size() - 1 && (seen += time_errors[bin]) < left; ++bin) continue;
    out["time_error"] = {{"p99", std::min(top_of_bin(bin), std::max(largest_early, largest_late))},
                         {"largest_early", largest_early},
                         {"largest_late", largest_late}};
  }
  for (std::size_t k = 0; k < ns.size(); ++k)
    if (!ns[k].empty())
      out["ns"][kNearnessNames[k]] = {
          {"queries", timed[k]}, {"median", median(ns[k])}, {"mean", mean(ns[k])}};
  return out;
}

void measure(std::span<const Question> questions, std::span<const Truth> truths, Kind kind,
             std::span<const ElementaryTest* const> tests, int passes, std::mt19937_64& random,
             std::span<Tally*> tallies) {
  std::array<std::vector<std::size_t>, 3> classes;
  for (std::size_t i = 0; i < questions.size(); ++i)
    classes[static_cast<std::size_t>(truths[i].nearness)].push_back(i);
  std::vector<std::size_t> order(tests.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::vector<Answer> answers(questions.size());
  for (int pass = 0; pass < passes; ++pass) {
    shuffle(order, random);
    for (const std::size_t number : order) {
      Tally& tally = *tallies[number];
      double whole = 0;
      for (std::size_t k = 0; k < classes.size(); ++k) {
        if (classes[k].empty()) continue;
        const auto begin = std::chrono::steady_clock::now();
        for (const std::size_t i : classes[k]) answers[i] = ask(*tests[number], questions[i], kind);
        const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
        tally.ns[k].push_back(spent.count() / static_cast<double>(classes[k].size()));
        whole += spent.count();
      }
      tally.block_ns.push_back(whole);
      if (pass + 1 < passes) continue;
      for (std::size_t i = 0; i < questions.size(); ++i)
        tally.count(questions[i], kind, truths[i], answers[i]);
      for (std::size_t k = 0; k < classes.size(); ++k) tally.timed[k] += classes[k].size();
    }
  }
}

}  // namespace cscd::bench
