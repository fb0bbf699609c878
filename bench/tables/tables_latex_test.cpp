#include "bench/tables/tables_latex.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bench/tables/wide_records.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

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
