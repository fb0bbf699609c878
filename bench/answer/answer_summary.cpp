#include "bench/answer/answer_summary.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

namespace cscd::bench {
namespace {

using nlohmann::json;
using Names = std::pair<std::string, std::string>;

constexpr std::size_t kMostListed = 5;  // of pairs of names, in a text

std::string number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string many(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

std::string moment_text(const Input& input, const ClipMoment& moment) {
  const std::optional<double> seconds = second_of(input, moment);
  std::string text = "frame " + number(frame_of(input, moment));
  if (seconds) text += " (" + number(*seconds) + " s)";
  return text;
}

std::vector<std::pair<Names, std::size_t>> most_first(const std::map<Names, std::size_t>& counts) {
  std::vector<std::pair<Names, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

// "eye_l in head: 96 pairs, teeth in head: 12 pairs, and 3 more".
template <class Text>
std::string listed(const std::map<Names, std::size_t>& counts, const Text& text) {
  std::string out;
  const auto sorted = most_first(counts);
  for (std::size_t i = 0; i < std::min(kMostListed, sorted.size()); ++i)
    out += (i > 0 ? ", " : "") + text(sorted[i].first, sorted[i].second);
  if (sorted.size() > kMostListed) out += ", and " + std::to_string(sorted.size() - kMostListed) + " more";
  return out;
}

std::string verdict_line(const Input& input, const AnswerSummary& s) {
  if (!s.collides() && s.count(IntervalVerdict::undecided) > 0)
    return "may touch itself: the elementary test could not tell; ask again with another --elementary";
  if (!s.collides()) return "does not touch itself";
  const bool crosses = s.count(IntervalVerdict::intersects_at_start) > 0;
  return std::string(crosses ? "intersects itself" : "touches itself") + ", first at " +
         moment_text(input, *s.first);
}

}  // namespace

std::size_t AnswerSummary::intervals() const {
  return std::accumulate(verdicts.begin(), verdicts.end(), std::size_t{0});
}

void AnswerSummary::add(const IntervalAnswer& answer, const SurfaceNames& names) {
  ++verdicts[static_cast<std::size_t>(answer.verdict)];
  ++strategies[std::string(answer.strategy->name)];
  proven += answer.proven;
  with_left_out += answer.rest_pairs + answer.rest_contacts > 0;
  embedding_ms += answer.embedding_ms;
  query_ms += answer.report.ms.total();
  load_ms += answer.load_ms;
  wall_ms += answer.wall_ms;
  if (answer.verdict == IntervalVerdict::clear || answer.verdict == IntervalVerdict::undecided) return;

  const bool crosses = answer.verdict == IntervalVerdict::intersects_at_start;
  const ClipMoment moment{answer.index, crosses ? 0 : answer.time().value_or(0)};
  if (!first) first = moment;
  const std::size_t contacts =
      static_cast<std::size_t>(std::count_if(answer.found.contacts.begin(), answer.found.contacts.end(),
                                             [](const Contact& c) { return c.verdict == Verdict::contact; }));
  if (!worst || std::tie(answer.start.total, contacts) > std::tie(worst->start_pairs, worst->contacts))
    worst = Worst{moment, answer.start.total, contacts};

  std::set<Names> here;
  const auto meet = [&](TriangleId a, TriangleId b) {
    std::string x = names.place_of(a), y = names.place_of(b);
    if (y < x) std::swap(x, y);
    here.emplace(std::move(x), std::move(y));
  };
  for (const CrossingPair& pair : answer.start.pairs) meet(pair.first, pair.second);
  for (const Contact& contact : answer.found.contacts)
    if (contact.verdict == Verdict::contact)
      meet(names.triangle_of(contact.pair, false), names.triangle_of(contact.pair, true));
  for (const Names& both : here) ++met[both];
}

json summary_json(const Input& input, const AnswerSummary& s) {
  json strategies = json::array(), met = json::array(), first, worst;
  for (const auto& [name, count] : s.strategies) strategies.push_back({{"name", name}, {"intervals", count}});
  for (const auto& [names, count] : most_first(s.met))
    met.push_back({{"first", names.first}, {"second", names.second}, {"intervals", count}});
  if (s.first) first = moment_json(input, *s.first);
  if (s.worst) {
    worst = moment_json(input, s.worst->moment);
    worst["start_pairs"] = s.worst->start_pairs;
    worst["contacts"] = s.worst->contacts;
  }
  return {{"intervals", s.intervals()},
          {"clear", s.count(IntervalVerdict::clear)},
          {"touches", s.count(IntervalVerdict::touches)},
          {"intersects_at_start", s.count(IntervalVerdict::intersects_at_start)},
          {"undecided", s.count(IntervalVerdict::undecided)},
          {"proven", s.proven},
          {"ms",
           {{"query", s.query_ms},
            {"embedding", s.embedding_ms},
            {"wall", s.wall_ms},
            {"load", s.load_ms},
            {"preparation", s.preparation_ms}}},
          {"with_left_out", s.with_left_out},
          {"strategies", std::move(strategies)},
          {"first", std::move(first)},
          {"worst", std::move(worst)},
          {"met", std::move(met)}};
}

std::string summary_text(const Input& input, const SurfaceNames& names, const AnswerSummary& s,
                         const Crossings& rest, bool left_out) {
  std::string out = "  " + verdict_line(input, s) + "\n";
  out += "  " + many(s.intervals(), "interval") + ": " + std::to_string(s.count(IntervalVerdict::clear)) +
         " clear, " + std::to_string(s.count(IntervalVerdict::touches)) + " touch, " +
         std::to_string(s.count(IntervalVerdict::intersects_at_start)) + " intersect at their start";
  if (s.count(IntervalVerdict::undecided) > 0)
    out += ", " + std::to_string(s.count(IntervalVerdict::undecided)) + " undecided";
  out += "\n";
  if (s.worst) {
    out += "  worst: interval " + std::to_string(s.worst->moment.interval) + ", from " +
           moment_text(input, {s.worst->moment.interval, 0}) + ": ";
    if (s.worst->start_pairs > 0)
      out += many(s.worst->start_pairs, "pair") + " of triangles cross at its start, and ";
    out += many(s.worst->contacts, "contact") + "\n";
  }
  if (!s.met.empty())
    out += "  met: " +
           listed(s.met,
                  [](const Names& both, std::size_t count) {
                    return both.first + " and " + (both.first == both.second ? "itself" : both.second) +
                           " (" + many(count, "interval") + ")";
                  }) +
           "\n";
  if (rest.total > 0) {
    out += "  crosses at rest: " +
           listed(pairs_by_part(names, input.mesh, rest), [](const Names& both, std::size_t count) {
             return both.first +
                    (both.first == both.second ? " with itself: " : " in " + both.second + ": ") +
                    many(count, "pair");
           });
    out += left_out
               ? "; left out of " + many(s.with_left_out, "interval") + " (--keep-rest-crossings counts it)"
               : "; counted, as asked";
    out += "\n";
  }
  std::string answered;
  for (const auto& [name, count] : s.strategies)
    answered += (answered.empty() ? "" : ", ") + name +
                (s.strategies.size() > 1 ? " (" + std::to_string(count) + ")" : "");
  out += "  answered by " + answered + ", " +
         (s.proven == s.intervals()
              ? "every answer proven"
              : std::to_string(s.proven) + " of " + std::to_string(s.intervals()) + " proven") +
         "\n  took " + number(s.wall_ms) + " ms: " + number(s.query_ms) + " to find contacts, " +
         number(s.embedding_ms) + " to know what crosses at the starts; " + number(s.preparation_ms) +
         " ms to prepare and " + number(s.load_ms) + " ms to read frames came on top\n";
  return out;
}

}  // namespace cscd::bench
