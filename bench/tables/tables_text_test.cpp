#include "bench/tables/tables_text.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "bench/tables/test_tables.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

std::string text_of(const std::vector<Record>& records) {
  const std::vector<ShapedTable> tables = shaped_of(records);
  return tables_text(tables, remarks(tables, judge_claims(records), records), "site/index.html");
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0, length = 0;
  for (const char c : text) longest = std::max(longest, length = c == '\n' ? 0 : length + 1);
  return longest;
}

// One table in all places. Two columns of a group stand beneath its title.
TEST(TablesText, PlaceTheSameTexts) {
  const ShapedTable table = {"t",
                             "Table 1. Sizes",
                             "K: thousands.",
                             "scene",
                             {{"", 1}, {"RVBC", 2}},
                             {{"Tri", ""}, {"BVOT", "K"}, {"ET", "ms"}},
                             {{"rope", "measured", {"48,440", "1,458", "0.2*"}},
                              {"", "published", {"48,440", "260.1", ""}},
                              {"my_scene", "", {"7", "", "0.1"}, true}}};
  const std::string note(kShortfallMeaning), today(kTodayNote);
  EXPECT_EQ(tables_text(std::vector{table}, std::vector<Remark>{{"measured", "here"}}, "site"),
            "Table 1. Sizes\nK: thousands.\n"
            "                       -- RVBC --\n"
            "                  Tri   BVOT   ET\n"
            "                           K   ms\n"
            "rope measured  48,440  1,458 0.2*\n"
            "     published 48,440  260.1    -\n" +
                today +
                ":\n"
                "my_scene            7      -  0.1\n"
                "\n" +
                note + "\nmeasured    here\npage        site\n");
  EXPECT_EQ(markdown_of(table),
            "| scene | Tri | RVBC BVOT (K) | RVBC ET (ms) |\n"
            "|---|---:|---:|---:|\n"
            "| rope, measured | 48,440 | 1,458 | 0.2\\* |\n"
            "| published | 48,440 | 260.1 | – |\n"
            "| *" +
                today +
                "* |  |  |  |\n"
                "| my_scene | 7 | – | 0.1 |\n");
  const std::string tex = latex_table(table);
  for (const std::string& part :
       {"\\caption{Sizes (the paper's Table 1). K: thousands. " + note + ".}\n",
        std::string("& \\multicolumn{1}{c}{} & \\multicolumn{2}{c}{RVBC} \\\\\n\\cmidrule(lr){3-4}\n"),
        std::string("\nrope & 48,440 & 1,458 & 0.2* \\\\\n\\quad published & 48,440 & 260.1 & -- \\\\\n"),
        std::string("\nmy\\_scene & 7 & -- & 0.1 \\\\\n\\bottomrule\n")})
    EXPECT_NE(tex.find(part), std::string::npos) << part << tex;
}

TEST(TablesText, HaveOneFootnote) {
  std::vector<Record> records = wide_records({"rope"});
  records.push_back(wide_record("hand", Pipeline::vectorised));
  EXPECT_EQ(text_of(records).find(kShortfallMark), std::string::npos);
  EXPECT_EQ(text_of(records).find("no record"), std::string::npos);
  EXPECT_NE(text_of(records).find(kTodayNote), std::string::npos);
  for (Record& record : records) record.verification.strategies = {{"drvbc", "first_contact", 5, 4, 5, {}}};
  const std::string text = text_of(records);
  EXPECT_EQ(text.find(kShortfallMeaning), text.rfind(kShortfallMeaning));
  EXPECT_NE(text.find(kShortfallMeaning), std::string::npos);
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
    const std::string page = tables_markdown(shaped_of(records), judge_claims(records), records);
    EXPECT_NE(page.find("\n## The paper's claims\n\nNone is made where " + std::string(why)),
              std::string::npos)
        << page;
    for (const std::string& said : {text, page})
      for (const char* claim : {"times faster than", "reproduced", "(claims.md)"})
        EXPECT_EQ(said.find(claim), std::string::npos) << claim << said;
    for (const ShapedTable& list : page_lists(records))
      for (const ShapedTable::Line& line : list.lines)
        EXPECT_EQ(line.scene.find("times faster"), std::string::npos) << list.id << ": " << line.scene;
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

TEST(TablesMarkdown, OfAFullRecordIsShort) {
  std::vector<std::string> scenes = {"rope", "hand", "octopus", "man", "box", "urchin"};
  for (std::size_t i = 0; i < 6; ++i) scenes.push_back(scenes[i] + "_contact");
  const std::vector<Record> records = wide_records(scenes);
  const std::string page = tables_markdown(shaped_of(records), judge_claims(records), records);
  EXPECT_LE(lines_of(page), 250u);
  for (const char* part : {"\n## Table 1. ", "\n## Table 2. ", "\n## Table 3. ", "\n| drvbc_fast | ",
                           "\n| rope, published | ", "\n| speedup-base | ", "\n| rope_contact, today | "})
    EXPECT_NE(page.find(part), std::string::npos) << part << page;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++found;
  return found;
}

TEST(LatexTables, HaveThePapersShape) {
  const std::string text = latex_table(shaped_of(wide_records({"rope"}))[1]);
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
      for (const ShapedTable& table : shaped_of(records, intervals))
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
