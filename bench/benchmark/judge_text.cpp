#include <algorithm>
#include <cstdio>
#include <numeric>

#include "bench/benchmark/judge.h"
#include "bench/compare/statistics/statistics.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

ordered_json score_json(const Score& score) {
  ordered_json out = {{"intervals", score.intervals},
                      {"answered", score.answered},
                      {"broken", score.broken},
                      {"expected", score.expected},
                      {"misses", score.misses},
                      {"inventions", score.inventions},
                      {"undecided", score.undecided},
                      {"timed", score.timed},
                      {"late", score.late},
                      {"early", score.early},
                      {"latest", score.latest},
                      {"earliest", score.earliest},
                      {"starts_told", score.starts_told},
                      {"starts_wrong", score.starts_wrong},
                      {"start_pairs_missed", score.start_pairs_missed},
                      {"start_pairs_invented", score.start_pairs_invented},
                      {"collides_told", score.collides_told},
                      {"collides_wrong", score.collides_wrong}};
  if (!score.milliseconds.empty())
    out["milliseconds"] = {
        {"answers", score.milliseconds.size()},
        {"median", median(score.milliseconds)},
        {"sum", std::accumulate(score.milliseconds.begin(), score.milliseconds.end(), 0.0)}};
  return out;
}

std::vector<std::string> cells(const std::string& name, const Score& score) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  const bool has_times = !score.milliseconds.empty();
  return {
      name,
      count(score.answered) + " of " + count(score.intervals),
      count(score.expected),
      count(score.misses),
      count(score.inventions),
      count(score.undecided),
      count(score.broken),
      count(score.late),
      brief(score.latest),
      count(score.early),
      brief(score.earliest),
      score.starts_told == 0 ? "-" : count(score.starts_wrong) + " of " + count(score.starts_told),
      has_times ? brief(median(score.milliseconds)) : "-",
      has_times ? brief(std::accumulate(score.milliseconds.begin(), score.milliseconds.end(), 0.0)) : "-"};
}

}  // namespace

ordered_json to_json(const Judgement& judgement) {
  ordered_json sets = ordered_json::object(), families = ordered_json::object(),
               faults = ordered_json::array();
  for (const std::string& set : judgement.set_order) sets[set] = score_json(judgement.set(set));
  for (const std::string& family : judgement.family_order)
    families[family] = score_json(judgement.families.at(family));
  for (const Fault& fault : judgement.faults) faults.push_back({{"id", fault.id}, {"what", fault.what}});
  return {{"schema", "cscd.score/1"},
          {"program", judgement.program},
          {"version", judgement.version},
          {"benchmark", judgement.benchmark},
          {"notes", judgement.notes},
          {"all", score_json(judgement.all())},
          {"sets", std::move(sets)},
          {"families", std::move(families)},
          {"unanswered", judgement.unanswered},
          {"fault_count", judgement.fault_count},
          {"faults", std::move(faults)}};
}

std::string describe(const Judgement& judgement, bool by_family) {
  static const std::vector<std::string> kHead = {
      "",     "answered", "expected", "misses",   "inventions",   "undecided", "broken",
      "late", "latest",   "early",    "earliest", "starts wrong", "median ms", "sum of ms"};
  std::vector<std::vector<std::string>> rows;
  if (by_family) {
    for (const std::string& family : judgement.family_order)
      rows.push_back(cells(family, judgement.families.at(family)));
  } else {
    for (const std::string& set : judgement.set_order) rows.push_back(cells(set, judgement.set(set)));
  }
  rows.push_back(cells("all", judgement.all()));

  std::vector<std::size_t> width;
  for (std::size_t column = 0; column < kHead.size(); ++column) {
    width.push_back(kHead[column].size());
    for (const auto& row : rows) width[column] = std::max(width[column], row[column].size());
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string out = row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t column = 1; column < row.size(); ++column)
      out += "  " + std::string(width[column] - row[column].size(), ' ') + row[column];
    return out + "\n";
  };
  std::string out =
      judgement.program + (judgement.version.empty() ? "" : " " + judgement.version) + "\n" + line(kHead);
  for (const auto& row : rows) out += line(row);
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, judgement.faults.size()); ++i)
    out += judgement.faults[i].id + " " + judgement.faults[i].what + "\n";
  if (judgement.fault_count > kShown)
    out += "and " + std::to_string(judgement.fault_count - kShown) +
           " faults more; --json lists the first 1000\n";
  if (!judgement.unanswered.empty())
    out += std::to_string(judgement.unanswered.size()) + " intervals are not answered, the first is " +
           judgement.unanswered.front() + "; --json lists all\n";
  return out;
}

}  // namespace cscd::bench
