#include <CLI/App.hpp>
#include <cstdio>
#include <optional>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/compare/comparison.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"

namespace cscd::bench {
namespace {

struct CompareOptions {
  std::string before, after, lane = "all", json, markdown;
  bool force = false, show_all = false;
};

void compare_sides(const CompareOptions& options) {
  OutputFile json(options.json, options.force), markdown(options.markdown, options.force, ".md");
  const Side before = read_side(options.before), after = read_side(options.after);
  const Comparison comparison =
      compare(before, after, options.lane == "counters" ? Lane::counters : Lane::all);
  json.commit(json_text(comparison_json(comparison)));
  markdown.commit(comparison_markdown(comparison));
  std::fputs(comparison_text(comparison, options.show_all).c_str(), stdout);
  end_with(exit_status(comparison.verdict()));
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare",
      "Tell whether a program got faster or slower, truer or less true, from records of both.\n\n"
      "  cscd compare before after                   two folders of records\n"
      "  cscd compare old.json,old2.json new.json    several records of one program, with commas between\n"
      "  cscd compare before after --lane counters   truth, counters and memory; no times\n\n"
      "The verdict goes by truth first, then counters, then memory, then times. Truth is verification,\n"
      "digests of contacts, first times, and what the elementary tests missed or invented. Counters are\n"
      "compared exactly. A time has changed only where its 95 % interval over processes excludes 0, the\n"
      "change is larger than the smallest that is reported, and it has the same sign in all pairings, each\n"
      "of a layout of the old program with one of the new. Times need six processes a side, measured in\n"
      "turns, as scripts/compare-commits does; each line says which change it could have seen. Where no\n"
      "verdict about times is possible, the times of both sides are shown all the same, with the reason.\n\n"
      "Exit status: 0 nothing worse; 1 worse or less true; 2 something could not be compared, and the rest\n"
      "is not worse.");
  using C = CompareOptions;
  static const OptionRow<C> rows[] = {
      required<C>({"old", &C::before, "records of the old program: files or folders, commas between"}),
      required<C>({"new", &C::after, "records of the new program: the same"}),
      {.name = "--lane",
       .member = &C::lane,
       .help = "what is compared: all, or everything but times (counters)",
       .choices = {"all", "counters"}},
      {"--json", &C::json, "where the comparison goes as JSON; - is standard output"},
      {"--markdown", &C::markdown, "where it goes as Markdown, for a pull request"},
      {"--all", &C::show_all, "show every finding and every time, scene by scene"},
      {"--force", &C::force, "replace files that exist"}};
  add_options<C>(*command, rows, *options);
  command->callback([options] { compare_sides(*options); });
}

}  // namespace cscd::bench
