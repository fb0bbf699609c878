#include <CLI/App.hpp>
#include <cstdio>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/harness/random_verification.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"

namespace cscd::bench {

void add_verify(CLI::App& app) {
  struct Options : RandomVerification {
    std::vector<std::string> strategies;
    std::string folder = ".";
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "verify",
      "Hold every strategy to its guarantee on random small noisy meshes, the exact oracle judging.\n\n"
      "  cscd verify --intervals 10000\n"
      "  cscd verify --intervals 10000 --strategy \"drvbc_fast,drvbc_fast --first\"\n\n"
      "\"STRATEGY --first\" looks for the earliest contact alone.\n\n"
      "A failing interval is written as a point cache that `cscd query` replays. Exit status 1 if there is "
      "one.");
  using O = Options;
  static const OptionRow<O> rows[] = {
      {"--intervals", &O::intervals, "how many"},
      {"--strategy", &O::strategies, "strategies or groups of them, with commas between; default all"},
      {"--seed", &O::first_seed, "the first interval's seed; the next ones count up"},
      {"--brute-every", &O::brute_every, "all pairs as the reference for every so many"},
      {"--thick", &O::thick, "every interval at a random thickness, by the strategies that know distances"},
      {"--failures", &O::folder, "folder for failing intervals"}};
  add_options<O>(*command, rows, *options);
  command->get_option("--brute-every")->check(CLI::PositiveNumber);
  command->callback([options] {
    std::vector<StrategyRow> rows = rows_called(options->strategies);
    if (rows.empty()) rows = rows_of(strategies());
    Progress progress("verify", options->intervals);
    const RandomSummary summary =
        verify_random(*options, rows, [&](std::size_t done) { progress.set(done); });
    std::printf("%s", describe(summary).c_str());
    for (const RandomFailure& failure : summary.failures)
      std::printf("FAILED %s\n", write_failure(failure, options->folder).c_str());
    if (!summary.failures.empty()) end_with(ExitStatus::failed);
  });
}

}  // namespace cscd::bench
