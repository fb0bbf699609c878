#include "bench/tables/shaped_table.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/tables_text.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

// Records in which every table has long figures with long intervals.
Record wide_record(const std::string& scene, Pipeline pipeline) {
  Record record;
  record.environment = {{"cpu", "AMD EPYC"},       {"cores", 2},       {"compiler", "GNU 12"},
                        {"build_type", "Release"}, {"commit", "0123"}, {"date", "2026-11-25T22:40:26Z"}};
  record.scene.name = scene;
  record.scene.vertices = 24222, record.scene.triangles = 48440, record.scene.bones = 100;
  record.pipeline = pipeline;
  record.timed_intervals = {0};
  record.counted_intervals = {0};
  double ms = pipeline == Pipeline::vectorised ? 0.1234 : 1.2345;
  for (const char* name : {"base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast",
                           "drvbc_fast_complete", "drvbc_fast_swept_bounds"}) {
    StrategyRecord row;
    row.name = name;
    row.guarantee = row.name.starts_with("drvbc") || row.name == "rvbc" ? "first_contact" : "complete";
    row.counts = {{"bvot", {1458321}},           {"pctp", {480123}},  {"negative", {1051}},
                  {"uncertain", {607}},          {"clusters", {176}}, {"feature_pairs", {6123456}},
                  {"elementary_tests", {123456}}};
    row.preparation.atomic_clusters = 199;
    row.preparation.distance_and_heat_ms = row.preparation.decomposition_ms = {1234.5, 2345.6};
    for (const char* stage : {"refit", "rv_update", "traversal", "elementary", "streaming"})
      row.ms[stage] = {{ms * 9.87}, {ms * 123.4}, {ms * 98.76}, {ms * 111.1}, {ms * 101.3}};
    ms *= 1.37;
    record.strategies.push_back(row);
  }
  return record;
}

// The given scenes in both pipelines.
std::vector<Record> wide_records(const std::vector<std::string>& scenes) {
  std::vector<Record> records;
  for (const std::string& scene : scenes)
    for (const Pipeline pipeline : {Pipeline::vectorised, Pipeline::published})
      records.push_back(wide_record(scene, pipeline));
  return records;
}

std::vector<ShapedTable> shaped_of(const std::vector<Record>& records, bool intervals = false) {
  return shaped_tables(filled_tables(records), records, intervals);
}

std::string text_of(const std::vector<Record>& records) {
  return tables_text(shaped_of(records), judge_claims(records), records, "site/index.html");
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0, length = 0;
  for (const char c : text) longest = std::max(longest, length = c == '\n' ? 0 : length + 1);
  return longest;
}

// The paper's Table 2 begins: rope, 0.07, 0.16, 0.03, 0.22, 28.4, 18.9x, 6.0x. Mutation: another order of
// columns.
TEST(ShapedTables, HaveThePapersRowsColumnsAndOrder) {
  const std::vector<ShapedTable> tables = shaped_of(wide_records({"rope"}));
  ASSERT_EQ(tables.size(), 3u);
  using Cells = std::vector<std::string>;
  for (const ShapedTable& table : tables) {
    ASSERT_EQ(table.lines.size(), 2u) << table.id;
    EXPECT_EQ(table.lines[0].scene, "rope");
    EXPECT_EQ(table.lines[0].kind, "measured");
    EXPECT_EQ(table.lines[1].kind, "published");
    EXPECT_TRUE(std::ranges::none_of(table.lines[0].cells, &std::string::empty)) << table.id;
  }
  EXPECT_EQ(tables[0].lines[1].cells, (Cells{"48440", "24222", "21.5", "30", "100", "3", "83", "6.8", "28.4",
                                             "199", "95", "53", "38 [2, 76]"}));
  EXPECT_EQ(tables[1].lines[1].cells, (Cells{"0.07", "0.16", "0.03", "0.22", "28.4", "18.9", "6"}));
  EXPECT_EQ(tables[2].lines[1].cells, (Cells{"260.1", "25.4", "6.1", "11", "39", "56.1", "99.1", "13.9",
                                             "6.8", "5.4", "16.2", "28.4", "2"}));
}

// Mutation: `today` wins where there are records of both pipelines.
TEST(ShapedTables, ShowThePapersCodeWhereItWasMeasuredAndOthersBelow) {
  std::vector<Record> records = wide_records({"rope"});
  records.push_back(wide_record("rope_contact", Pipeline::vectorised));
  const ShapedTable times = shaped_of(records)[2];
  ASSERT_EQ(times.lines.size(), 3u);
  EXPECT_FALSE(times.lines[0].of_today);
  EXPECT_TRUE(times.begins_today(2));
  EXPECT_EQ(times.lines[2].kind, "") << "nothing was published of it";
  const std::vector<Record> alone = {records[0]};
  EXPECT_NE(shaped_of(alone)[2].lines[0].cells, times.lines[0].cells);
  EXPECT_NE(text_of(records).find(kTodayNote), std::string::npos);
}

TEST(ShapedTables, LeaveOutWhatWasNotMeasured) {
  std::vector<Record> records = wide_records({"rope"});
  for (Record& record : records)
    std::erase_if(record.strategies, [](const StrategyRecord& row) { return row.name == "mcd"; });
  const ShapedTable hierarchies = shaped_of(records)[1];
  EXPECT_EQ(hierarchies.lines[0].cells[1], "");
  EXPECT_NE(hierarchies.lines[0].cells[0], "");
  EXPECT_EQ(text_of(records).find("no record"), std::string::npos);
  for (Record& record : records)
    std::erase_if(record.strategies, [](const StrategyRecord& row) { return row.name != "base"; });
  EXPECT_TRUE(shaped_of(records).empty());
}

TEST(ShapedTables, HaveIntervalsOnRequestAlone) {
  const ShapedTable times = shaped_of(wide_records({"rope"}), true)[2];
  ASSERT_EQ(times.lines.size(), 4u);
  EXPECT_EQ(times.lines[1].kind, "low");
  EXPECT_EQ(times.lines[2].kind, "high");
  EXPECT_EQ(times.lines[1].cells[0], "") << "counters have no interval";
  EXPECT_LT(std::stod(times.lines[1].cells[2]), std::stod(times.lines[2].cells[2]));
}

// A time of a strategy that lost a contact carries its mark wherever it is printed, and ratios with it do.
// Mutation: the divisor's mark is forgotten.
TEST(ShapedTables, MarkTimesOfStrategiesThatLostContacts) {
  std::vector<Record> records = wide_records({"rope"});
  EXPECT_EQ(text_of(records).find(kShortfallMark), std::string::npos);
  for (Record& record : records) record.verification.strategies = {{"drvbc", "first_contact", 5, 4, 5, {}}};
  const std::vector<ShapedTable> tables = shaped_of(records);
  EXPECT_FALSE(tables[0].has_marks()) << "preparation and counters are no times of queries";
  EXPECT_FALSE(tables[1].lines[0].cells[0].ends_with(kShortfallMark));
  for (const std::size_t i : {4, 5, 6})
    EXPECT_TRUE(tables[1].lines[0].cells[i].ends_with(kShortfallMark)) << i;
  EXPECT_FALSE(tables[2].lines[0].cells[5].ends_with(kShortfallMark)) << "rvbc";
  EXPECT_TRUE(tables[2].lines[0].cells[11].ends_with(kShortfallMark)) << "drvbc";
  EXPECT_TRUE(times_of_strategies(records).has_marks());
  const std::string text = text_of(records);
  EXPECT_EQ(text.find(kMarkNote), text.rfind(kMarkNote)) << "one footnote";
  EXPECT_NE(text.find(kMarkNote), std::string::npos);
}

TEST(ShapedTables, MarkTimesWhereAPromiseDoesNotHold) {
  Record record = wide_record("rope", Pipeline::vectorised);
  record.verification.strategies = {{"base", "complete", 0, 0, 0, {}},
                                    {"drvbc", "first_contact", 0, 0, 0, {}}};
  EXPECT_FALSE(median_query("drvbc", record).marked);
  record.verification.unembedded = {0};
  EXPECT_TRUE(median_query("drvbc", record).marked);
  EXPECT_FALSE(median_query("base", record).marked);
}

// Mutation: a column that no figure needs so wide.
TEST(TablesText, FitATerminalOfAHundredColumns) {
  for (const std::vector<std::string>& scenes : {std::vector<std::string>{"rope"},
                                                 {"rope", "hand", "octopus", "man", "box", "urchin"},
                                                 {"rope", "octopus", "octopus_contact"}}) {
    const std::string text = text_of(wide_records(scenes));
    EXPECT_LE(longest_line(text), 100u) << text;
    EXPECT_LE(lines_of(text), scenes.size() == 1 ? 45u : 80u) << text;
    for (const char* line : {"\nmeasured ", "\npublished ", "\nclaims ", "\ndrvbc_fast ", "\npage "})
      EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

// The name of a row that is longer than the column of names. Mutation: its text begins without a blank.
TEST(TablesText, ComparesOnlyRowsThatAreAskedTheSame) {
  const std::string text = text_of(wide_records({"rope"}));
  EXPECT_NE(text.find("\ndrvbc_fast  "), std::string::npos) << text;
  EXPECT_NE(text.find(" ms the median query; first contact: "), std::string::npos) << text;
  EXPECT_NE(text.find(" times faster than drvbc\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\ndrvbc_fast_complete "), std::string::npos) << text;
  EXPECT_NE(text.find(" ms the median query; all contacts: "), std::string::npos) << text;
  // Of the median, as the milliseconds are. In every repetition, a row takes 1.37 times as long as the one
  // before.
  EXPECT_NE(text.find("first contact: 0.73 times faster than drvbc\n"), std::string::npos) << text;
}

// Mutation: what a few intervals or repetitions show is called reproduced, or faster.
TEST(TablesText, ClaimNothingFromAPartOfAScene) {
  std::vector<Record> part = wide_records({"rope"}), few = part;
  for (Record& record : part) record.scene.frames = 241, record.intervals = 8;
  for (Record& record : few)
    for (StrategyRecord& row : record.strategies)
      for (auto& [stage, repetitions] : row.ms) repetitions.resize(2);
  for (const auto& [records, why] : {std::pair(part, "the record of rope spans 8 of 240 intervals"),
                                     std::pair(few, "times are of 2 repetitions of 1 intervals")}) {
    const std::string text = text_of(records);
    EXPECT_NE(text.find("\nclaims      none is made where " + std::string(why)), std::string::npos) << text;
    const std::string page =
        tables_markdown(shaped_of(records), times_of_strategies(records), judge_claims(records), records);
    EXPECT_NE(page.find("\n## The paper's claims\n\nNone is made where " + std::string(why)),
              std::string::npos)
        << page;
    for (const std::string& said : {text, page})
      for (const char* claim : {"times faster than", "reproduced", "(claims.md)"})
        EXPECT_EQ(said.find(claim), std::string::npos) << claim << said;
    EXPECT_FALSE(any_measured(judge_claims(records)));
  }
  EXPECT_TRUE(any_measured(judge_claims(wide_records({"rope"}))));
}

// Mutation: one block of all scenes.
TEST(TablesText, FoldTablesThatAreTooWide) {
  std::vector<Record> records;
  for (int i = 0; i < 12; ++i)
    records.push_back(wide_record("a_scene_with_a_long_name_" + std::to_string(i), Pipeline::vectorised));
  const std::string text = text_of(records);
  EXPECT_LE(longest_line(text), 100u) << text;
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = text.find("\ndrvbc_fast_swept_bounds ", at)) != std::string::npos; ++at)
    ++rows;
  EXPECT_GT(rows, 1u) << text;
}

TEST(ShortText, HasThreeDigitsAndNoMoreDecimals) {
  const std::pair<double, const char*> texts[] = {
      {0, "0"},        {0.0001, "<0.001"}, {0.0006, "0.001"}, {0.00924, "0.009"}, {0.0201, "0.02"},
      {0.0995, "0.1"}, {0.1234, "0.123"},  {5.678, "5.68"},   {99.96, "100"},     {999.4, "999"},
      {999.6, "1000"}, {48440, "48440"},   {-5.678, "-5.68"}};
  for (const auto& [value, text] : texts) EXPECT_EQ(short_text(value), text);
}

TEST(TablesMarkdown, OfAFullRecordIsShort) {
  std::vector<std::string> scenes = {"rope", "hand", "octopus", "man", "box", "urchin"};
  for (std::size_t i = 0; i < 6; ++i) scenes.push_back(scenes[i] + "_contact");
  const std::vector<Record> records = wide_records(scenes);
  const std::string page =
      tables_markdown(shaped_of(records), times_of_strategies(records), judge_claims(records), records);
  EXPECT_LE(lines_of(page), 250u);
  for (const char* part : {"\n## Table 1. ", "\n## Table 2. ", "\n## Table 3. ", "\n| drvbc_fast | ",
                           "\n| rope, published | ", "\n| speedup-base | ", "\n| rope_contact, today | "})
    EXPECT_NE(page.find(part), std::string::npos) << part << page;
}

namespace fs = std::filesystem;

std::vector<ShapedTable> tables_of(const std::vector<Record>& records, bool intervals) {
  std::vector<ShapedTable> tables = shaped_tables(filled_tables(records), records, intervals);
  tables.push_back(times_of_strategies(records, intervals));
  return tables;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++found;
  return found;
}

TEST(LatexTables, HaveThePapersShape) {
  const std::string text = latex_table(tables_of(wide_records({"rope"}), false)[1]);
  EXPECT_NE(text.find("BVOT, DRVBC /} & \\multicolumn{2}{c}{PCTP, DRVBC /}"), std::string::npos) << text;
  EXPECT_NE(text.find("\\quad published & 0.07 & 0.16 & 0.03 & 0.22 & 28.4 & 18.9 & 6 "), std::string::npos)
      << text;
  EXPECT_EQ(text.find("ours"), std::string::npos);
  EXPECT_EQ(count(text, "\\begin{table*}"), 1u);
}

// In an article of one column and of two, with intervals and without. Mutation: no \resizebox.
TEST(LatexTables, CompileAndFitArticles) {
  if (std::system("kpsewhich booktabs.sty graphicx.sty article.cls >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no LaTeX here; install texlive-latex-recommended";
  const test::Folder scratch;
  std::vector<Record> records = wide_records({"rope", "hand", "octopus", "man", "box", "urchin"});
  records.push_back(wide_record("octopus_contact", Pipeline::vectorised));
  for (Record& record : records) record.verification.strategies = {{"drvbc", "first_contact", 5, 4, 5, {}}};
  for (const char* columns : {"onecolumn", "twocolumn"}) {
    std::ofstream article(scratch.path / "article.tex");
    article << "\\documentclass[" << columns
            << ",a4paper]{article}\n\\usepackage{booktabs,graphicx}\n\\begin{document}\nText.\n";
    for (const bool intervals : {false, true})
      for (const ShapedTable& table : tables_of(records, intervals))
        article << latex_table(table) << "\\clearpage\n";
    article << "\\end{document}\n";
    article.close();
    const std::string command =
        "cd '" + scratch.path.string() +
        "' && pdflatex -interaction=nonstopmode -halt-on-error article.tex >out.txt 2>&1";
    const int status = std::system(command.c_str());
    const std::string log = test::read(scratch / "article.log");
    ASSERT_EQ(status, 0) << log;
    for (const char* complaint : {"Overfull", "Float too large", "LaTeX Error"})
      EXPECT_EQ(count(log, complaint), 0u) << log.substr(std::min(log.find(complaint), log.size()), 300);
  }
}

}  // namespace

}  // namespace cscd::bench
