#include <gtest/gtest.h>
#include <string>

#include "bench/compare/comparison.h"
#include "bench/records/shortfall.h"

// What comparison_text() and comparison_markdown() say of findings; that these are found is in
// comparison_test.cpp.
namespace cscd::bench {
namespace {

Comparison with_findings() {
  Comparison c;
  c.old_commit = "0123456789abcdef", c.new_commit = "fedcba9876543210", c.new_dirty = true;
  c.scenes = {"hand"};
  c.compared_answers = 12, c.compared_counts = 30;
  c.counters = {{"hand", "base", "bvot", 100, 90, 4, 2, Change::better},
                {"hand", "mcd", "bvot", 100, 101, 4, 1, Change::worse},
                {"hand", "mcd", "clusters", 4, 5, 4, 4, Change::different},
                {"rope", "mcd", "pctp", 10, 30, 4, 4, Change::worse}};
  c.footprint = {{"hand", "base", "held_bytes", 1000, 1250, Change::worse}};
  TimeFinding time{"hand", "base", "total", 6, 2, 2.5};
  time.ratio = {1.25, 1.2, 1.3}, time.noise_floor = 0.02, time.smallest_detectable = 0.05;
  time.pairings = time.agreeing = 3, time.change = Change::worse;
  TimeFinding kept = time;
  kept.row = "mcd", kept.change = Change::same, kept.withheld = "below the floor", kept.of_shortfall = true;
  c.times = {time, kept};
  c.means = {{"base", 2, {1.1, 1.05, 1.15}}};
  return c;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(ComparisonText, BeginsWithTheVerdictAndItsReason) {
  Comparison c = with_findings();
  EXPECT_EQ(first_line(comparison_text(c)), "verdict: worse: 2 counters, 1 footprint, 1 time");
  c.refusals = {{"rope", "times", "other machines"}};
  EXPECT_EQ(first_line(comparison_text(c)),
            "verdict: worse: 2 counters, 1 footprint, 1 time; not everything could be compared");
  c.truth = {{"hand", "mcd", "other contacts", false},
             {"hand", "base", "lost a contact", true},
             {"rope", "", "lost", true}};
  EXPECT_EQ(first_line(comparison_text(c)), "verdict: less true: hand, base: lost a contact; and 1 more");
  Comparison none;
  none.compared_counts = 3;
  EXPECT_EQ(first_line(comparison_text(none)), "verdict: nothing worse");
  none.refusals = {{"a", "times", "no times"},
                   {"b", "times", "no times"},
                   {"c", "times", "no times"},
                   {"d", "times", "no times"},
                   {"e", "times", "no times"}};
  EXPECT_EQ(
      first_line(comparison_text(none)),
      "verdict: nothing worse in what was compared; a, b, c, d and 1 more: times not compared: no times");
}

// Mutations: a loss stands below a change; the smaller of two changes stands first.
TEST(ComparisonText, ShowsTheGravestFindingsFirst) {
  Comparison c = with_findings();
  c.truth = {{"hand", "mcd", "other contacts", false}, {"hand", "base", "lost a contact", true}};
  const std::string text = comparison_text(c);
  expect_in(text,
            "\nOLD 0123456789ab\nNEW fedcba987654 with uncommitted changes\n\ntruth: 1 loss in 12 answers\n");
  expect_in(text, "  LOST  hand, base: lost a contact\n  hand, mcd: other contacts\n");
  expect_in(text,
            "counters: 2 worse, 1 better, 1 different of 30 compared, of which 3 follow\n"
            "  scene and row  counter   OLD  NEW  intervals\n"
            "  rope, mcd      pctp      10   30   4 of 4     worse\n"
            "  hand, mcd      bvot      100  101  1 of 4     worse\n"
            "  hand, mcd      clusters  4    5    4 of 4     different\n");
}

TEST(ComparisonText, ShowsTimesWithTheirIntervals) {
  const std::string text = comparison_text(with_findings()), all = comparison_text(with_findings(), true);
  expect_in(text, "memory and instructions: 1 worse, 0 better\n");
  expect_in(text, "held_bytes  1,000  1,250  +25.0 %  worse\n");
  expect_in(text, "times: 1 worse, 0 better of 2 stages\n");
  expect_in(text,
            "  hand, base     total  2        2.5      +25.0 % [+20.0 %, +30.0 %]  5 %         2 %          "
            "3 of 3          worse\n");
  expect_in(text, "A whole query slower by 5 % would show in 4 of 5 such comparisons");
  expect_in(text, "base  2       +10.0 % [+5.0 %, +15.0 %]\n");
  EXPECT_EQ(text.find("below the floor"), std::string::npos)
      << "a time that did not change is shown on request";
  expect_in(all, "hand, mcd*");
  expect_in(all, "below the floor\n");
  expect_in(all, kShortfallMeaning);
  expect_in(text, "--all shows every finding");
}

TEST(ComparisonText, ShowsTimesWithoutAVerdict) {
  Comparison c;
  c.unjudged_times = {
      {"hand", "base", 2, 4, false}, {"rope", "base", 1, 2, false}, {"rope", "mcd", 3, {}, true}};
  const std::string text = comparison_text(c);
  expect_in(text, "times of a whole query without a verdict, milliseconds an interval\n");
  expect_in(text, "  base  2       1.414    2.828    +100.0 %    +100.0 % to +100.0 %\n");
  expect_in(comparison_text(c, true), "  rope, mcd*     3        -\n");
  c.unjudged_times = {{"hand", "base", 2, {}, false}, {"rope", "base", {}, 8, false}};
  expect_in(comparison_text(c), "of other scenes or settings on either side\n");
  expect_in(comparison_text(c), "  base  2        1       8        1\n");
}

TEST(ComparisonMarkdown, HasASectionForEachKindOfFinding) {
  Comparison c = with_findings();
  c.only_in_one = {"rope, only in OLD"};
  const std::string text = comparison_markdown(c);
  EXPECT_EQ(first_line(text), "## Verdict: worse: 2 counters, 1 footprint, 1 time");
  expect_in(text,
            "- truth: the same in 12 answers\n- counters: 2 worse, 1 better, 1 different of 30 compared\n");
  expect_in(text, "- not compared: rope, only in OLD\n");
  for (const char* section : {"Counters", "Memory and instructions", "Times that changed", "Over the scenes"})
    expect_in(text, "\n### " + std::string(section) + "\n\n| ");
  EXPECT_EQ(text.find("### Truth"), std::string::npos);
  expect_in(text, "<details><summary>All times</summary>\n\n| scene and row | stage | ");
}

}  // namespace
}  // namespace cscd::bench
