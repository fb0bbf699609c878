#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/output/output.h"
#include "core/base/error.h"
#include "scenes/hard/disturbance.h"

namespace cscd::bench {
namespace {

namespace hard = scenes::hard;

struct HardCasesOptions {
  std::string folder;
  std::size_t queries = 1000;
  std::uint64_t seed = 1;
  double hardness = 0;
  bool force = false;
};

void write_hard_cases(const HardCasesOptions& options) {
  const std::filesystem::path folder = options.folder;
  if (!std::filesystem::is_directory(folder))
    throw InputError("output " + options.folder + ": is not a folder; make it first");
  for (const hard::Family& family : hard::families())
    for (const hard::Kind kind : {hard::Kind::vertex_face, hard::Kind::edge_edge}) {
      const std::string name =
          std::string(family.name) + (kind == hard::Kind::vertex_face ? "-vf.csv" : "-ee.csv");
      OutputFile output(folder / name, options.force, ".csv");
      std::vector<Query> queries;
      std::size_t contacts = 0;
      for (std::size_t i = 0; i < options.queries; ++i) {
        Query& query = queries.emplace_back(
            options.hardness > 0 ? hard::random_query(family, kind, options.hardness, i, options.seed)
                                 : hard::suite_query(family, kind, i, options.seed));
        query.truth = hard::in_contact(query, kind);
        contacts += *query.truth;
      }
      output.commit(query_text(queries));
      std::printf("%-28s %zu queries, %zu contacts\n", name.c_str(), queries.size(), contacts);
    }
}

}  // namespace

void add_hardcases(CLI::App& app) {
  auto options = std::make_shared<HardCasesOptions>();
  CLI::App* command = app.add_subcommand(
      "hardcases",
      "Write the hard elementary queries, with the oracle's truth, in the public format (cscd "
      "elementary).\n\n"
      "  cscd hardcases --out FOLDER              the suite: on the lattice and some ulps off it\n"
      "  cscd hardcases --out FOLDER --hardness 1e-9   off the lattice by that share of their size\n\n"
      "Two files a family (cscd list families), FAMILY-vf.csv and FAMILY-ee.csv.");
  using H = HardCasesOptions;
  static const OptionRow<H> rows[] = {
      required<H>({"--out", &H::folder, "an existing folder"}),
      {"--queries", &H::queries, "of each family and kind", {{1, 10'000'000}}},
      {"--seed", &H::seed, "the same seed gives the same queries"},
      {.name = "--hardness",
       .member = &H::hardness,
       .help = "the smaller, the harder; 0: the suite",
       .range = {{0, 1}},
       .names_zero = true},
      {"--force", &H::force, "replace files that exist"}};
  add_options<H>(*command, rows, *options);
  command->callback([options] { write_hard_cases(*options); });
}

}  // namespace cscd::bench
