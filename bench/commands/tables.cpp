#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>

#include "bench/commands/command.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/tables/claims.h"
#include "bench/tables/paper_tables.h"
#include "bench/tables/record_inputs.h"
#include "bench/tables/tables_latex.h"
#include "bench/tables/tables_text.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

struct TableOptions {
  std::vector<std::string> records;
  std::string folder;
  TableChoice choice;
  bool no_intervals = false, force = false;
};

// Throws InputError for a name that leaves nothing to show.
void require_known(const TableChoice& choice, std::span<const Record> records,
                   std::span<const PaperTable> made) {
  for (const std::string& strategy : choice.strategies)
    if (std::ranges::none_of(records, [&](const Record& r) { return r.strategy(strategy) != nullptr; }))
      throw InputError("--strategy " + strategy + ": in no record that was given; choose another");
  for (const std::string& scene : choice.scenes)
    if (std::ranges::none_of(made, [&](const PaperTable& table) {
          return std::ranges::any_of(table.rows, [&](const Row& row) { return row.scene == scene; });
        }))
      throw InputError("--scene " + scene + ": neither published nor in a record; choose another");
  if (std::ranges::all_of(made, [](const PaperTable& table) { return table.columns.empty(); }))
    throw InputError("--columns, --strategy: no column is left; the keys of columns are in tables.csv");
}

void leave_intervals_out(std::vector<PaperTable>& tables) {
  for (PaperTable& table : tables)
    for (Row& row : table.rows)
      for (Cell& cell : row.cells) cell.measured.interval.reset();
}

void tables(const TableOptions& options) {
  const std::vector<Record> records = read_records(options.records);
  std::vector<PaperTable> made = paper_tables(records, options.choice);
  require_known(options.choice, records, made);
  if (options.no_intervals) leave_intervals_out(made);
  const std::string markdown = tables_markdown(made, records);
  if (options.folder.empty()) {
    std::fputs(markdown.c_str(), stdout);
    return;
  }
  const std::filesystem::path folder(options.folder);
  OutputFile json(folder / "tables.json", options.force), text(folder / "tables.md", options.force, ".md"),
      csv(folder / "tables.csv", options.force, ".csv"), page(folder / "claims.md", options.force, ".md");
  for (const PaperTable& table : made)
    if (table.columns.size() > kMostLatexRows)
      std::fprintf(
          stderr,
          "%s.tex: not written, %zu rows are too many for a page; choose with --strategy or --columns\n",
          table.id.c_str(), table.columns.size());
  std::deque<OutputFile> floats;
  const std::vector<LatexTable> latex = latex_tables(made);
  for (const LatexTable& table : latex)
    floats.emplace_back(folder / (table.name + ".tex"), options.force, ".tex");
  const std::vector<ClaimResult> claims = judge_claims(records);
  json.commit(json_text(tables_json(made, claims, records)));
  text.commit(markdown);
  csv.commit(tables_csv(made));
  for (std::size_t i = 0; i < latex.size(); ++i) floats[i].commit(latex[i].text);
  page.commit(claims_markdown(claims));
}

}  // namespace

void add_tables(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* command = app.add_subcommand(
      "tables",
      "Make the paper's tables from records, published figures beside measured ones.\n\n"
      "  cscd tables rope.json                     on standard output, as Markdown\n"
      "  cscd tables rope.json --out results/new   tables.json, .md, .csv, claims.md in an existing folder,\n"
      "                                            and for LaTeX table1.tex and so on\n"
      "  cscd tables rope.json hand.json --scene rope --strategy drvbc,base --columns speedup,pctp\n"
      "  cscd tables rope.json rope-published.json      both pipelines beside the paper\n\n"
      "Times are means over the timed intervals, the median over the repetitions; ratios are paired within "
      "a\n"
      "repetition; intervals are 95 % bootstrap intervals. A cell that cannot be filled says why.");
  command->add_option("records", options->records, "what cscd run wrote, at most one a scene and pipeline")
      ->required();
  command->add_option("--out", options->folder, "the folder for the files");
  command->add_option("--scene", options->choice.scenes, "these scenes alone, with commas between")
      ->delimiter(',');
  command
      ->add_option("--strategy", options->choice.strategies,
                   "columns that are about these strategies alone, with commas between")
      ->delimiter(',');
  command
      ->add_option("--columns", options->choice.columns,
                   "columns whose keys (tables.csv has them) contain one of these texts")
      ->delimiter(',');
  command->add_flag("--no-intervals", options->no_intervals, "leave the 95 % intervals out");
  command->add_flag("--force", options->force, "replace files that exist");
  command->callback([options] { tables(*options); });
}

}  // namespace cscd::bench
