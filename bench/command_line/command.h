#pragma once

// The subcommands of `cscd`: each registers itself on the program and runs in its callback. A refused input
// is an InputError (main prints its line and ends with ExitStatus::refused); a run that answers "no" leaves
// by end_with().

// Whole, because a program that links any command links what CLI::App refers to.
#include <CLI/CLI.hpp>

#include "bench/output/exit_status.h"

namespace cscd::bench {

void add_query(CLI::App& app);
void add_view(CLI::App& app);
void add_inspect(CLI::App& app);
void add_elementary(CLI::App& app);
void add_run(CLI::App& app);
void add_tables(CLI::App& app);
void add_report(CLI::App& app);
void add_compare(CLI::App& app);
void add_history(CLI::App& app);
void add_export(CLI::App& app);
void add_list(CLI::App& app);
void add_verify(CLI::App& app);
void add_clusters(CLI::App& app);
void add_hardcases(CLI::App& app);
void add_benchmark(CLI::App& app);
void add_accuracy(CLI::App& app);
void add_scale(CLI::App& app);
void add_scene(CLI::App& app);
void add_help(CLI::App& app);

}  // namespace cscd::bench
