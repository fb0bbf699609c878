#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "bench/commands/command.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/tables/claims.h"
#include "bench/tables/paper_tables.h"
#include "bench/tables/record_inputs.h"
#include "bench/tables/tables_text.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

struct TableOptions {
  std::vector<std::string> records;
  std::string folder, scene;
  bool force = false;
};

void tables(const TableOptions& options) {
  const std::vector<Record> records = read_records(options.records);
  const std::vector<PaperTable> made = paper_tables(records, options.scene);
  if (std::all_of(made.begin(), made.end(), [](const PaperTable& table) { return table.rows.empty(); }))
    throw InputError("--scene " + options.scene + ": neither published nor in a record; choose another");
  const std::string markdown = tables_markdown(made, records);
  if (options.folder.empty()) {
    std::fputs(markdown.c_str(), stdout);
    return;
  }
  const std::filesystem::path folder(options.folder);
  OutputFile json(folder / "tables.json", options.force), text(folder / "tables.md", options.force, ".md"),
      csv(folder / "tables.csv", options.force, ".csv"), latex(folder / "tables.tex", options.force, ".tex"),
      page(folder / "claims.md", options.force, ".md");
  const std::vector<ClaimResult> claims = judge_claims(records);
  json.commit(json_text(tables_json(made, claims, records)));
  text.commit(markdown);
  csv.commit(tables_csv(made));
  latex.commit(tables_latex(made));
  page.commit(claims_markdown(claims));
}

}  // namespace

void add_tables(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* command = app.add_subcommand(
      "tables",
      "Make the paper's tables from records, published figures beside measured ones.\n\n"
      "  cscd tables rope.json                     on standard output, as Markdown\n"
      "  cscd tables rope.json --out results/new   tables.json, .md, .csv, .tex and claims.md in an "
      "existing folder\n\n"
      "Times are means over the timed intervals, the median over the repetitions; ratios are paired within "
      "a\n"
      "repetition; intervals are 95 % bootstrap intervals. A cell that cannot be filled says why.");
  command->add_option("records", options->records, "what cscd run wrote, at most one a scene")->required();
  command->add_option("--out", options->folder, "the folder for the files");
  command->add_option("--scene", options->scene, "rows of this scene alone");
  command->add_flag("--force", options->force, "replace files that exist");
  command->callback([options] { tables(*options); });
}

}  // namespace cscd::bench
