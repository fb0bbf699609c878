#include "bench/tables/tables_latex.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;

// A folder that is gone after the test.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("cscd-latex-test-" + std::to_string(getpid()));
  Scratch() { fs::create_directories(path); }
  ~Scratch() { fs::remove_all(path); }
};

// A record in which every table has long figures with long intervals.
Record wide_record(const std::string& scene, Pipeline pipeline) {
  Record record;
  record.scene.name = scene;
  record.scene.vertices = 24222, record.scene.triangles = 48440, record.scene.bones = 100;
  record.pipeline = pipeline;
  record.timed_intervals = {0};
  record.counted_intervals = {0};
  double ms = pipeline == Pipeline::today ? 0.1234 : 1.2345;
  for (const char* name : {"base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast",
                           "drvbc_fast_complete", "drvbc_fast_swept_bounds"}) {
    StrategyRecord row;
    row.name = name;
    row.guarantee = "complete";
    row.counts = {{"bvot", {1458321}},           {"pctp", {480123}},  {"negative", {1051}},
                  {"uncertain", {607}},          {"clusters", {176}}, {"feature_pairs", {6123456}},
                  {"elementary_tests", {123456}}};
    row.preparation.atomic_clusters = 199;
    row.preparation.distance_and_heat_ms = row.preparation.decomposition_ms = {1234.5, 2345.6};
    for (const char* stage : {"refit", "rv_update", "traversal", "elementary", "streaming"})
      row.ms[stage] = {{ms * 9.87}, {ms * 123.4}, {ms * 98.76}, {ms * 111.1}};
    ms *= 1.37;
    record.strategies.push_back(row);
  }
  return record;
}

std::vector<Record> wide_records() {
  std::vector<Record> records;
  for (const char* scene :
       {"rope", "hand", "octopus", "man", "box", "urchin", "rope_contact", "hand_contact"})
    for (const Pipeline pipeline : {Pipeline::today, Pipeline::published})
      records.push_back(wide_record(scene, pipeline));
  return records;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++found;
  return found;
}

TEST(LatexTables, HaveColumnsOfTheirOwnForMeasuredAndPublished) {
  const std::vector<Record> records = {wide_record("rope", Pipeline::today)};
  const std::vector<PaperTable> tables =
      paper_tables(records, {{"rope"}, {"drvbc", "base"}, {"speedup_base"}});
  const std::vector<LatexTable> latex = latex_tables(tables);
  ASSERT_FALSE(latex.empty());
  EXPECT_EQ(latex[0].name, "table2");
  EXPECT_NE(latex[0].text.find("{ours} & {paper}"), std::string::npos) << latex[0].text;
  EXPECT_NE(latex[0].text.find(" & 18.9 "), std::string::npos) << latex[0].text;  // published
  EXPECT_NE(latex[0].text.find("\\tiny"), std::string::npos) << latex[0].text;
  for (const LatexTable& table : latex) EXPECT_EQ(count(table.text, "\\begin{table*}"), 1u) << table.name;
}

// Mutation: a share of less than a millionth is printed as zero.
TEST(LatexTables, PrintNoSmallShareAsZero) {
  Record record = wide_record("rope", Pipeline::today);
  for (StrategyRecord& row : record.strategies)
    if (row.name == "drvbc")
      row.counts["pctp"] = {1};
    else
      row.counts["pctp"] = {20'000'000};
  const std::vector<Record> records = {record};
  const std::vector<LatexTable> latex =
      latex_tables(paper_tables(records, {{"rope"}, {"drvbc", "base"}, {"pctp_over_base"}}));
  ASSERT_FALSE(latex.empty());
  EXPECT_NE(latex[0].text.find("{$<$0.000001}"), std::string::npos) << latex[0].text;
}

// Mutation: a column wider than its numbers ask for, a page of one more row, a name that cannot be broken.
TEST(LatexTables, CompileAndFitATwoColumnArticle) {
  if (std::system("kpsewhich siunitx.sty tabularx.sty booktabs.sty article.cls >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no LaTeX with siunitx here; install texlive-latex-recommended and texlive-science";
  const Scratch scratch;
  const std::vector<Record> records = wide_records();
  const std::vector<LatexTable> latex = latex_tables(paper_tables(records));
  ASSERT_GE(latex.size(), 6u);
  std::ofstream article(scratch.path / "article.tex");
  article << "\\documentclass[twocolumn,a4paper]{article}\n\\usepackage{booktabs,tabularx,siunitx}\n"
             "\\begin{document}\nText.\n";
  for (const LatexTable& table : latex) {
    std::ofstream(scratch.path / (table.name + ".tex")) << table.text;
    article << "\\input{" << table.name << "}\n\\clearpage\n";
  }
  article << "\\end{document}\n";
  article.close();
  const std::string command =
      "cd '" + scratch.path.string() +
      "' && pdflatex -interaction=nonstopmode -halt-on-error article.tex >out.txt 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream file(scratch.path / "article.log");
  const std::string log{std::istreambuf_iterator<char>(file), {}};
  ASSERT_EQ(status, 0) << log;
  for (const char* complaint : {"Overfull", "Float too large", "LaTeX Error"})
    EXPECT_EQ(count(log, complaint), 0u) << log.substr(std::min(log.find(complaint), log.size()), 300);
}

}  // namespace
}  // namespace cscd::bench
