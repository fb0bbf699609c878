#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>

#include "bench/compare/comparison.h"
#include "bench/output/markdown.h"
#include "bench/records/shortfall.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

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

std::string commit_text(const std::string& commit, bool dirty) {
  return commit.substr(0, 12) + (dirty ? " with uncommitted changes" : "");
}

std::string with_row(const std::string& scene, const std::string& row) {
  return row.empty() ? scene : scene + ", " + row;
}

std::string mark(bool of_shortfall) {
  return of_shortfall ? std::string(kShortfallMark) : "";
}

bool is_reported(const TimeFinding& time) {
  return time.change != Change::same;
}

// How many of the findings are worse, better and merely different.
template <class Finding>
std::string tally(const std::vector<Finding>& findings) {
  const auto count = [&](Change change) {
    return std::ranges::count_if(findings, [&](const Finding& finding) { return finding.change == change; });
  };
  std::string out =
      std::to_string(count(Change::worse)) + " worse, " + std::to_string(count(Change::better)) + " better";
  if (const auto different = count(Change::different)) out += ", " + std::to_string(different) + " different";
  return out;
}

std::size_t losses(const Comparison& c) {
  return static_cast<std::size_t>(std::ranges::count_if(c.truth, &TruthFinding::is_lost));
}

std::string truth_line(const Comparison& c) {
  const std::string of = " in " + many(c.compared_answers, "answer");
  if (losses(c) > 0) return std::to_string(losses(c)) + (losses(c) == 1 ? " loss" : " losses") + of;
  if (c.compared_answers == 0) return "not compared";
  return c.truth.empty() ? "the same" + of : "nothing lost" + of + "; " + many(c.truth.size(), "change");
}

std::string counters_line(const Comparison& c) {
  return c.compared_counts == 0
             ? "not compared"
             : tally(c.counters) + " of " + std::to_string(c.compared_counts) + " compared";
}

std::string footprint_line(const Comparison& c) {
  return c.compared_counts == 0 && c.footprint.empty() ? "not compared" : tally(c.footprint);
}

// Refusals for the same reason in one line each.
std::vector<std::string> refusal_lines(const Comparison& c) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const Refusal& refusal : c.refusals) {
    const std::string text = refusal.what + " not compared: " + refusal.reason;
    auto group = std::ranges::find(groups, text, &std::pair<std::string, std::vector<std::string>>::first);
    if (group == groups.end()) group = groups.insert(groups.end(), {text, {}});
    if (!refusal.scene.empty()) group->second.push_back(refusal.scene);
  }
  std::vector<std::string> lines;
  for (const auto& [text, scenes] : groups)
    lines.push_back((scenes.empty() ? "" : first_of(scenes, 4, "") + ": ") + text);
  return lines;
}

// The verdict, and what speaks for it most.
std::string verdict_line(const Comparison& c) {
  const std::string verdict(to_string(c.verdict()));
  const auto worse = [](const auto& findings) {
    return static_cast<std::size_t>(
        std::ranges::count(findings, Change::worse, [](const auto& f) { return f.change; }));
  };
  switch (c.verdict()) {
    case ComparisonVerdict::less_true: {
      const TruthFinding& first = *std::ranges::find_if(c.truth, &TruthFinding::is_lost);
      return verdict + ": " + with_row(first.scene, first.row) + ": " + first.text +
             (losses(c) > 1 ? "; and " + std::to_string(losses(c) - 1) + " more" : "");
    }
    case ComparisonVerdict::worse: {
      std::string what;
      const auto add = [&](std::size_t count, const std::string& one) {
        if (count > 0) what += (what.empty() ? ": " : ", ") + many(count, one);
      };
      add(worse(c.counters), "counter");
      add(worse(c.footprint), "footprint");
      add(worse(c.times), "time");
      return verdict + what + (c.refusals.empty() ? "" : "; not everything could be compared");
    }
    case ComparisonVerdict::not_comparable: {
      const std::string why = refusal_lines(c).front();
      if (c.compared_answers + c.compared_counts == 0) return verdict + ": " + why;
      return "nothing worse in what was compared; " + why;
    }
    case ComparisonVerdict::nothing_worse:
      break;
  }
  return verdict;
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
         " would show in 4 of 5 such comparisons (" + percent(std::ranges::min(detectable)) + " to " +
         percent(std::ranges::max(detectable)) +
         ", by row and scene). The noise floor, what as many processes of OLD differ by among themselves, "
         "is " +
         percent(median(floors)) + " (" + percent(std::ranges::min(floors)) + " to " +
         percent(std::ranges::max(floors)) + ").";
}

// What is worse first, and then by how much OLD and NEW differ, as a share.
template <class Finding>
std::vector<Finding> gravest_first(std::vector<Finding> findings) {
  const auto rank = [](const Finding& f) {
    const double before = static_cast<double>(f.before), after = static_cast<double>(f.after);
    const double least = std::min(before, after), most = std::max(before, after);
    return std::pair(f.change != Change::worse, most > 0 ? least / most : 1);
  };
  std::ranges::stable_sort(findings, {}, rank);
  return findings;
}

Rows counter_rows(const Comparison& c) {
  Rows rows;
  for (const CounterFinding& f : gravest_first(c.counters))
    rows.push_back({with_row(f.scene, f.row), f.counter, std::to_string(f.before), std::to_string(f.after),
                    std::to_string(f.intervals_that_differ) + " of " + std::to_string(f.intervals),
                    std::string(to_string(f.change))});
  return rows;
}
const std::vector<std::string> kCounterHead = {"scene and row", "counter", "OLD", "NEW", "intervals", ""};

Rows footprint_rows(const Comparison& c) {
  Rows rows;
  for (const FootprintFinding& f : gravest_first(c.footprint))
    rows.push_back({with_row(f.scene, f.row), f.what, short_text(f.before), short_text(f.after),
                    change_text(f.after / f.before), std::string(to_string(f.change))});
  return rows;
}
const std::vector<std::string> kFootprintHead = {"scene and row", "what", "OLD", "NEW", "change", ""};

Rows time_rows(const Comparison& c, bool reported_only) {
  Rows rows;
  for (const TimeFinding& f : c.times) {
    if (reported_only && !is_reported(f)) continue;
    rows.push_back({with_row(f.scene, f.row) + mark(f.of_shortfall), f.stage, short_text(f.before_ms),
                    short_text(f.after_ms), interval_text(f.ratio), percent(f.smallest_detectable),
                    percent(f.noise_floor), std::to_string(f.agreeing) + " of " + std::to_string(f.pairings),
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

std::string number_or_dash(const std::optional<double>& value) {
  return value ? short_text(*value) : "-";
}

Rows unjudged_rows(const Comparison& c) {
  Rows rows;
  for (const UnjudgedTime& t : c.unjudged_times)
    rows.push_back({with_row(t.scene, t.row) + mark(t.of_shortfall), number_or_dash(t.before_ms),
                    number_or_dash(t.after_ms),
                    t.before_ms && t.after_ms ? change_text(*t.after_ms / *t.before_ms) : ""});
  return rows;
}
const std::vector<std::string> kUnjudgedHead = {"scene and row", "OLD, ms", "NEW, ms", "differs by"};

// What the whole queries of a row take, over the scenes: those of either side, and those that both have.
struct RowTimes {
  std::string row;
  std::vector<double> before = {}, after = {}, shared_before = {}, shared_after = {}, ratios = {};
  bool of_shortfall = false;
};

// The rows that most scenes have come first.
std::vector<RowTimes> unjudged_by_row(const Comparison& c) {
  std::vector<RowTimes> rows;
  for (const UnjudgedTime& t : c.unjudged_times) {
    auto row = std::ranges::find(rows, t.row, &RowTimes::row);
    if (row == rows.end()) row = rows.insert(rows.end(), RowTimes{.row = t.row});
    row->of_shortfall = row->of_shortfall || t.of_shortfall;
    if (t.before_ms) row->before.push_back(*t.before_ms);
    if (t.after_ms) row->after.push_back(*t.after_ms);
    if (!t.before_ms || !t.after_ms) continue;
    row->shared_before.push_back(*t.before_ms), row->shared_after.push_back(*t.after_ms);
    row->ratios.push_back(*t.after_ms / *t.before_ms);
  }
  std::ranges::stable_sort(rows, std::greater(),
                           [](const RowTimes& row) { return row.before.size() + row.after.size(); });
  return rows;
}

double geometric_mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

// Of rows that both sides timed on the same scenes.
Rows unjudged_means(const std::vector<RowTimes>& all) {
  Rows rows;
  for (const RowTimes& row : all)
    if (!row.ratios.empty())
      rows.push_back({row.row + mark(row.of_shortfall), std::to_string(row.ratios.size()),
                      short_text(geometric_mean(row.shared_before)),
                      short_text(geometric_mean(row.shared_after)), change_text(geometric_mean(row.ratios)),
                      change_text(*std::ranges::min_element(row.ratios)) + " to " +
                          change_text(*std::ranges::max_element(row.ratios))});
  return rows;
}
const std::vector<std::string> kUnjudgedMeanHead = {"row",     "scenes",     "OLD, ms",
                                                    "NEW, ms", "differs by", "in single scenes"};

// Where the sides share no scene, so that their times cannot be told from each other's scenes.
Rows unshared_means(const std::vector<RowTimes>& all) {
  const auto mean_text = [](const std::vector<double>& values) {
    return values.empty() ? "-" : short_text(geometric_mean(values));
  };
  Rows rows;
  for (const RowTimes& row : all)
    rows.push_back({row.row + mark(row.of_shortfall), mean_text(row.before),
                    std::to_string(row.before.size()), mean_text(row.after),
                    std::to_string(row.after.size())});
  return rows;
}
const std::vector<std::string> kUnsharedHead = {"row", "OLD, ms", "scenes", "NEW, ms", "scenes"};

// Columns of a plain text, each as wide as its widest cell.
std::string plain_table(const std::vector<std::string>& head, const Rows& rows) {
  std::vector<std::size_t> width;
  const auto length = [](const std::string& text) {  // in characters of UTF-8
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
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

// A table of at most so many rows; nothing without rows.
std::string plain_table(const std::vector<std::string>& head, Rows rows, std::size_t most) {
  if (rows.empty()) return "";
  rows.resize(std::min(most, rows.size()));
  return plain_table(head, rows);
}

// ", of which 3 follow", where a table is cut.
std::string cut_text(std::size_t count, std::size_t most) {
  return count > most ? ", of which " + std::to_string(most) + " follow" : "";
}

std::string unjudged_text(const Comparison& c, bool all, std::size_t most) {
  if (c.unjudged_times.empty()) return "";
  const std::string title = "times of a whole query without a verdict, milliseconds an interval";
  if (all) return title + "\n" + plain_table(kUnjudgedHead, unjudged_rows(c));
  const std::vector<RowTimes> by_row = unjudged_by_row(c);
  const Rows means = unjudged_means(by_row);
  if (means.empty())
    return title + ", of other scenes or settings on either side" + cut_text(by_row.size(), most) + "\n" +
           plain_table(kUnsharedHead, unshared_means(by_row), most);
  return title + cut_text(means.size(), most) + "\n" + plain_table(kUnjudgedMeanHead, means, most);
}

std::string shortfall_line(const Comparison& c) {
  const bool marked = std::ranges::any_of(c.times, &TimeFinding::of_shortfall) ||
                      std::ranges::any_of(c.unjudged_times, &UnjudgedTime::of_shortfall);
  return marked ? std::string(kShortfallMeaning) + "\n" : "";
}

}  // namespace

std::string comparison_text(const Comparison& c, bool all) {
  // Rows of a table where not all are shown. Two full records then fit on a screen.
  const std::size_t some = all ? SIZE_MAX : 3, most = all ? SIZE_MAX : 12;
  std::string out = "verdict: " + verdict_line(c) + "\nOLD " + commit_text(c.old_commit, c.old_dirty) +
                    "\nNEW " + commit_text(c.new_commit, c.new_dirty) + "\n\ntruth: " + truth_line(c) +
                    cut_text(c.truth.size(), some) + "\n";
  std::vector<TruthFinding> truth = c.truth;
  std::ranges::stable_sort(truth, std::greater(), &TruthFinding::is_lost);
  for (std::size_t i = 0; i < std::min(some, truth.size()); ++i)
    out += (truth[i].is_lost ? "  LOST  " : "  ") + with_row(truth[i].scene, truth[i].row) + ": " +
           truth[i].text + "\n";
  out += "counters: " + counters_line(c) + cut_text(c.counters.size(), some) + "\n" +
         plain_table(kCounterHead, counter_rows(c), some);
  out += "memory and instructions: " + footprint_line(c) + cut_text(c.footprint.size(), some) + "\n" +
         plain_table(kFootprintHead, footprint_rows(c), some);
  if (!c.times.empty())
    out += "times: " + tally(c.times) + " of " + std::to_string(c.times.size()) + " stages\n" +
           plain_table(kTimeHead, time_rows(c, !all), most);
  if (const std::string power = power_line(c); !power.empty()) out += power + "\n";
  out += plain_table(kMeanHead, mean_rows(c), most) + unjudged_text(c, all, most) + shortfall_line(c);
  for (const std::string& line : refusal_lines(c)) out += line + "\n";
  if (all)
    for (const std::string& one : c.only_in_one) out += "not compared: " + one + "\n";
  else if (!c.only_in_one.empty())
    out += "not compared: " + first_of(c.only_in_one, 4, "") + "\n";
  return out + (all ? "" : "--all shows every finding, and every time scene by scene\n");
}

std::string comparison_markdown(const Comparison& c) {
  std::string out =
      "## Verdict: " + verdict_line(c) + "\n\nOLD is " + commit_text(c.old_commit, c.old_dirty) +
      ", NEW is " + commit_text(c.new_commit, c.new_dirty) + ".\n\n- truth: " + truth_line(c) +
      "\n- counters: " + counters_line(c) + "\n- memory and instructions: " + footprint_line(c) + "\n";
  if (!c.times.empty())
    out += "- times: " + tally(c.times) + " of " + std::to_string(c.times.size()) + " stages\n";
  for (const std::string& line : refusal_lines(c)) out += "- " + line + "\n";
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
  section("Times without a verdict", kUnjudgedHead, unjudged_rows(c));
  if (const std::string line = shortfall_line(c); !line.empty()) out += "\n" + line;
  return out;
}

}  // namespace cscd::bench
