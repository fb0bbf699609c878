#include <CLI/App.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/compare/history.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

struct HistoryOptions : CourseChoice {
  HistoryOptions() { stage = kSpeedupStage; }
  std::string folder = "results/history", records, json;
  bool all = false, force = false;
};

void keep_entry(const HistoryOptions& options) {
  const Side side = read_side(options.records);
  const nlohmann::ordered_json entry = history_entry(side, committed_date(options.folder, side.commit));
  const std::filesystem::path file = history_file(options.folder, entry);
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  const std::string commit = entry.at("commit");
  for (const std::filesystem::directory_entry& kept :
       std::filesystem::directory_iterator(file.parent_path(), error))
    if (kept.path().filename().string().ends_with("-" + commit.substr(0, 10) + ".json"))
      throw InputError("history " + kept.path().string() + ": is there, and a history is never rewritten");
  OutputFile(file, false).commit(json_text(entry));
  std::printf("kept: %s\n", file.string().c_str());
}

void history(const HistoryOptions& options) {
  if (!options.records.empty()) return keep_entry(options);
  std::vector<Course> courses = read_courses(options.folder, options);
  if (courses.empty())
    throw InputError("no entry of " + options.folder + " has such a row; see cscd history");
  const bool chosen = !options.row.empty() || !options.scene.empty();
  // Rows of the groups, which vary one thing or another, are for whoever asks for them.
  const auto is_variant = [](const Course& course) {
    const auto rows = strategies_in("");
    return std::ranges::none_of(rows, [&](const Strategy* row) { return row->name == course.row; });
  };
  const bool in_short = !chosen && !options.all && options.stage == kSpeedupStage;
  const std::size_t variants = in_short ? std::erase_if(courses, is_variant) : 0;
  if (!options.json.empty()) OutputFile(options.json, options.force).commit(json_text(courses_json(courses)));
  std::string text = in_short ? speedups_text(courses) : courses_text(courses, chosen, options.all);
  if (variants > 0)
    text += "left out: " + many(variants, "course") + " of variants; --row names one, --all shows all\n";
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_history(CLI::App& app) {
  auto options = std::make_shared<HistoryOptions>();
  CLI::App* command = app.add_subcommand(
      "history",
      "Show how fast each row was, commit by commit, and where that changed.\n\n"
      "  cscd history                                        the speedup of every row, and its changes\n"
      "  cscd history --scene hand --row drvbc_fast          every commit of this row\n"
      "  cscd history --stage total                          what a query took, on each kind of machine\n"
      "  cscd history --keep FOLDER                          add an entry of the records in FOLDER\n\n"
      "An entry is one small JSON file a commit and kind of machine, and is never rewritten. A change of\n"
      "level is a commit from which on a row is faster or slower. Such commits are found exactly, as the\n"
      "segments that fit the logarithms best when each of them costs a fixed amount (optimal partitioning).\n"
      "A speedup is a ratio within one run, over base or else drvbc. So it goes on from machine to machine,\n"
      "and changes where either row does; times are those of one kind of machine.");
  using H = HistoryOptions;
  static const OptionRow<H> rows[] = {
      {"folder", &H::folder, "the folder of the entries"},
      {"--machine", &H::machine, "of this kind of machine alone: a folder's name"},
      {"--scene", &H::scene, "of this scene alone"},
      {"--row", &H::row, "of this row alone"},
      {.name = "--stage",
       .member = &H::stage,
       .help = "of this stage of a query",
       .type = "TEXT:{speedup,total,refit,rv_update,traversal,elementary,embedding,start,preparation}"},
      {"--all", &H::all, "show courses of a single commit too"},
      {"--keep", &H::records,
       "add an entry of these records: files or folders, commas between. Git is asked for the "
       "commit's date,\nso the folder of entries lies in the repository"},
      {"--json", &H::json, "where the courses go as JSON; - is standard output"},
      {"--force", &H::force, "replace that file if it exists"}};
  add_options<H>(*command, rows, *options);
  command->callback([options] { history(*options); });
}

}  // namespace cscd::bench
