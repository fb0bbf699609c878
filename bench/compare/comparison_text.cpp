#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/compare/comparison.h"
#include "bench/compare/stage_samples.h"
#include "bench/output/markdown.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

// "+3.1 %" of a ratio.
std::string change_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f %%", 100 * (ratio - 1));
  return text;
}

std::string interval_text(const Estimate& ratio) {
  return change_text(ratio.value) + " [" + change_text(ratio.low) + ", " + change_text(ratio.high) + "]";
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string commit_text(const std::string& commit, bool dirty) {
  return commit.substr(0, 12) + (dirty ? " with uncommitted changes" : "");
}

std::string with_row(const std::string& scene, const std::string& row) {
  return row.empty() ? scene : scene + ", " + row;
}

bool is_reported(const TimeFinding& time) {
  return time.change != Change::same;
}

// How many of the findings are worse, better and merely different.
template <class Finding>
std::string tally(const std::vector<Finding>& findings) {
  const auto count = [&](Change change) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const Finding& finding) { return finding.change == change; });
  };
  std::string out =
      std::to_string(count(Change::worse)) + " worse, " + std::to_string(count(Change::better)) + " better";
  if (const auto different = count(Change::different)) out += ", " + std::to_string(different) + " different";
  return out;
}

std::string truth_line(const Comparison& c) {
  const auto lost = std::count_if(c.truth.begin(), c.truth.end(), [](const auto& f) { return f.is_lost; });
  return lost > 0          ? std::to_string(lost) + " losses"
         : c.truth.empty() ? "the same"
                           : "nothing lost; " + std::to_string(c.truth.size()) + " changes";
}

// What this comparison could have seen.
std::string power_line(const Comparison& c) {
  if (c.times.empty()) return "";
  std::vector<double> detectable, floors;
  for (const TimeFinding& time : c.times) {
    if (time.stage != kTotal) continue;
    detectable.push_back(time.smallest_detectable);
    floors.push_back(time.noise_floor);
  }
  if (detectable.empty()) return "";
  return "A whole query slower by " + percent(median(detectable)) +
         " would show in 4 of 5 such comparisons (" +
         percent(*std::min_element(detectable.begin(), detectable.end())) + " to " +
         percent(*std::max_element(detectable.begin(), detectable.end())) +
         ", by row and scene). The noise floor, what as many processes of OLD differ by among themselves, "
         "is " +
         percent(median(floors)) + " (" + percent(*std::min_element(floors.begin(), floors.end())) + " to " +
         percent(*std::max_element(floors.begin(), floors.end())) + ").";
}

Rows counter_rows(const Comparison& c) {
  Rows rows;
  for (const CounterFinding& f : c.counters)
    rows.push_back({with_row(f.scene, f.row), f.counter, std::to_string(f.before), std::to_string(f.after),
                    std::to_string(f.intervals_that_differ) + " of " + std::to_string(f.intervals),
                    std::string(to_string(f.change))});
  return rows;
}
const std::vector<std::string> kCounterHead = {"scene and row", "counter", "OLD", "NEW", "intervals", ""};

Rows footprint_rows(const Comparison& c) {
  Rows rows;
  for (const FootprintFinding& f : c.footprint)
    rows.push_back({with_row(f.scene, f.row), f.what, number(f.before), number(f.after),
                    change_text(f.after / f.before), std::string(to_string(f.change))});
  return rows;
}
const std::vector<std::string> kFootprintHead = {"scene and row", "what", "OLD", "NEW", "change", ""};

Rows time_rows(const Comparison& c, bool reported_only) {
  Rows rows;
  for (const TimeFinding& f : c.times) {
    if (reported_only && !is_reported(f)) continue;
    rows.push_back({with_row(f.scene, f.row), f.stage, number(f.before_ms), number(f.after_ms),
                    interval_text(f.ratio), percent(f.smallest_detectable), percent(f.noise_floor),
                    std::to_string(f.agreeing) + " of " + std::to_string(f.pairings),
                    is_reported(f) ? std::string(to_string(f.change)) : f.withheld});
  }
  return rows;
}
const std::vector<std::string> kTimeHead = {"scene and row", "stage",          "OLD, ms",
                                            "NEW, ms",       "change",         "detectable",
                                            "noise floor",   "pairings agree", ""};

Rows mean_rows(const Comparison& c) {
  Rows rows;
  for (const MeanFinding& f : c.means)
    rows.push_back({f.row, std::to_string(f.scenes), interval_text(f.ratio)});
  return rows;
}
const std::vector<std::string> kMeanHead = {"row", "scenes", "geometric mean of the change"};

// Columns of a plain text, each as wide as its widest cell.
std::string plain_table(const std::vector<std::string>& head, const Rows& rows) {
  std::vector<std::size_t> width;
  const auto length = [](const std::string& text) {  // in characters of UTF-8
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  };
  for (const std::string& cell : head) width.push_back(length(cell));
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], length(row[i]));
  std::string out;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line = "  ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(width[i] - length(row[i]) + 2, ' ');
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add(head);
  for (const auto& row : rows) add(row);
  return out;
}

std::string plain_or_nothing(const std::vector<std::string>& head, const Rows& rows) {
  return rows.empty() ? "" : plain_table(head, rows);
}

std::string refusal_text(const Refusal& refusal) {
  return (refusal.scene.empty() ? "" : refusal.scene + ": ") + refusal.what +
         " not compared: " + refusal.reason;
}

ordered_json interval_json(const Estimate& ratio) {
  return {ratio.low, ratio.high};
}

}  // namespace

std::string comparison_text(const Comparison& c) {
  std::string out = "OLD " + commit_text(c.old_commit, c.old_dirty) + "\nNEW " +
                    commit_text(c.new_commit, c.new_dirty) + "\n\ntruth: " + truth_line(c) + "\n";
  for (const TruthFinding& f : c.truth)
    out += (f.is_lost ? "  LOST  " : "  ") + with_row(f.scene, f.row) + ": " + f.text + "\n";
  out += "counters: " + tally(c.counters) + " of " + std::to_string(c.compared_counts) + " compared\n" +
         plain_or_nothing(kCounterHead, counter_rows(c));
  out += "memory and instructions: " + tally(c.footprint) + "\n" +
         plain_or_nothing(kFootprintHead, footprint_rows(c));
  if (!c.times.empty())
    out += "times: " + tally(c.times) + " of " + std::to_string(c.times.size()) + " stages\n" +
           plain_table(kTimeHead, time_rows(c, false));
  if (const std::string power = power_line(c); !power.empty()) out += power + "\n";
  out += plain_or_nothing(kMeanHead, mean_rows(c));
  for (const Refusal& refusal : c.refusals) out += refusal_text(refusal) + "\n";
  for (const std::string& one : c.only_in_one) out += "not compared: " + one + "\n";
  return out + "\nverdict: " + std::string(to_string(c.verdict())) + "\n";
}

std::string comparison_markdown(const Comparison& c) {
  std::string out = "## Verdict: " + std::string(to_string(c.verdict())) + "\n\nOLD is " +
                    commit_text(c.old_commit, c.old_dirty) + ", NEW is " +
                    commit_text(c.new_commit, c.new_dirty) + ".\n\n- truth: " + truth_line(c) +
                    "\n- counters: " + tally(c.counters) + " of " + std::to_string(c.compared_counts) +
                    " compared\n- memory and instructions: " + tally(c.footprint) + "\n";
  if (!c.times.empty())
    out += "- times: " + tally(c.times) + " of " + std::to_string(c.times.size()) + " stages\n";
  for (const Refusal& refusal : c.refusals) out += "- " + refusal_text(refusal) + "\n";
  for (const std::string& one : c.only_in_one) out += "- not compared: " + one + "\n";
  if (!c.truth.empty()) {
    out += "\n### Truth\n\n";
    for (const TruthFinding& f : c.truth)
      out += (f.is_lost ? "- **lost** " : "- ") + with_row(f.scene, f.row) + ": " + f.text + "\n";
  }
  const auto section = [&](const char* title, const std::vector<std::string>& head, const Rows& rows) {
    if (!rows.empty()) out += "\n### " + std::string(title) + "\n\n" + markdown_table(head, rows);
  };
  section("Counters", kCounterHead, counter_rows(c));
  section("Memory and instructions", kFootprintHead, footprint_rows(c));
  section("Times that changed", kTimeHead, time_rows(c, true));
  if (const std::string power = power_line(c); !power.empty()) out += "\n" + power + "\n";
  if (!c.times.empty())
    out += "\n<details><summary>All times</summary>\n\n" + markdown_table(kTimeHead, time_rows(c, false)) +
           "\n</details>\n";
  section("Over the scenes", kMeanHead, mean_rows(c));
  return out;
}

ordered_json comparison_json(const Comparison& c) {
  const auto side = [](const std::string& commit, bool dirty) {
    return ordered_json{{"commit", commit}, {"dirty", dirty}};
  };
  ordered_json truth = ordered_json::array(), counters = ordered_json::array(),
               footprint = ordered_json::array(), times = ordered_json::array(),
               means = ordered_json::array(), refusals = ordered_json::array();
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
                     {"withheld", f.withheld}});
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
          {"counts_compared", c.compared_counts},
          {"counters", std::move(counters)},
          {"footprint", std::move(footprint)},
          {"times", std::move(times)},
          {"geometric_means", std::move(means)},
          {"not_compared", std::move(refusals)}};
}

}  // namespace cscd::bench
