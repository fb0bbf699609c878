#include <CLI/App.hpp>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <optional>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/tables/claims.h"
#include "bench/tables/filled_tables.h"
#include "bench/tables/record_inputs.h"
#include "bench/tables/shaped_table.h"
#include "bench/tables/tables_json.h"
#include "bench/tables/tables_text.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;

struct TableOptions {
  std::vector<std::string> records;
  std::string folder;
  bool intervals = false, no_claims = false, force = false;
};

// How a page of all figures of these records is written. A page that lies near them may be of other records.
std::string page_of(const TableOptions& options) {
  return options.records.size() == 1 ? "cscd report " + options.records.front() + " -o site"
                                     : "cscd report RECORDS -o site";
}

void tables(const TableOptions& options) {
  std::vector<RecordFile> files = std::move(record_files(options.records, {"run"}).at("run"));
  const std::vector<Record> records = read_records(files);
  const std::vector<FilledTable> made = filled_tables(records);
  const std::vector<ShapedTable> shaped = shaped_tables(made, records, options.intervals);
  const std::vector<ClaimResult> claims =
      options.no_claims ? std::vector<ClaimResult>() : judge_claims(records);
  if (options.folder.empty()) {
    const std::string text = tables_text(shaped, remarks(shaped, claims, records), page_of(options));
    std::fputs(text.c_str(), stdout);
    return;
  }
  const fs::path folder(options.folder);
  OutputFile json(folder / "tables.json", options.force), text(folder / "tables.md", options.force, ".md"),
      csv(folder / "tables.csv", options.force, ".csv");
  std::optional<OutputFile> page;  // tables.md links it where there is a claim to link
  if (any_measured(claims)) page.emplace(folder / "claims.md", options.force, ".md");
  std::deque<OutputFile> floats;
  for (const ShapedTable& table : shaped)
    floats.emplace_back(folder / (table.id + ".tex"), options.force, ".tex");
  json.commit(json_text(tables_json(made, shaped, claims, records)));
  text.commit(tables_markdown(shaped, claims, records));
  csv.commit(tables_csv(made));
  for (std::size_t i = 0; i < shaped.size(); ++i) floats[i].commit(latex_table(shaped[i]));
  if (page) page->commit(claims_markdown(claims));
}

}  // namespace

void add_tables(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  CLI::App* command = app.add_subcommand(
      "tables",
      "Make the paper's tables from records, published figures beneath measured ones.\n\n"
      "  cscd tables results/FOLDER                in the terminal\n"
      "  cscd tables rope.json rope-published.json\n"
      "  cscd tables rope.json --out results/new   tables.md, and claims.md where the records allow claims;\n"
      "                                            every figure of every strategy in\n"
      "                                            tables.json and .csv; table1.tex and so on for LaTeX.\n"
      "                                            The folder has to exist\n\n"
      "Times are means over the timed intervals, the median over the repetitions; ratios are paired within\n"
      "a repetition. A scene with a record of the pipeline `published` is shown in that one.");
  using T = TableOptions;
  static const OptionRow<T> rows[] = {
      required<T>({"records", &T::records,
                   "what cscd run wrote, at most one a scene and pipeline, or folders of it; other files of "
                   "this program are left out"}),
      {"--out", &T::folder, "the folder for the files"},
      {"--intervals", &T::intervals, "lines with the ends of the 95 % intervals too"},
      {"--no-claims", &T::no_claims,
       "hold no claim of the paper against these records, and write no claims.md"},
      {"--force", &T::force, "replace files that exist"}};
  add_options<T>(*command, rows, *options);
  command->callback([options] { tables(*options); });
}

}  // namespace cscd::bench
