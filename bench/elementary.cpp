#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/catalogue.h"
#include "bench/command.h"
#include "bench/output.h"
#include "core/elementary/query_file.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

struct ElementaryOptions {
  std::string file, kind, elementary = "exact", output;
  bool force = false;
};

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::apart:
      return "apart";
    case Verdict::contact:
      return "contact";
    case Verdict::undecided:
      return "undecided";
  }
  return "";
}

struct Summary {
  std::size_t queries = 0, contacts = 0, undecided = 0, with_truth = 0, false_positives = 0,
              false_negatives = 0;

  void add(const Answer& answer, const std::optional<bool>& truth) {
    ++queries;
    contacts += answer.verdict == Verdict::contact;
    undecided += answer.verdict == Verdict::undecided;
    if (!truth) return;
    ++with_truth;
    false_positives += answer.verdict == Verdict::contact && !*truth;
    false_negatives += answer.verdict == Verdict::apart && *truth;
  }
};

void run_elementary(const ElementaryOptions& options) {
  const ElementaryTest& test = elementary_test_named(options.elementary);
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output, options.force);
  const std::vector<Query> queries = read_queries(options.file);

  std::vector<Answer> answers;
  answers.reserve(queries.size());
  const bool vertex_face = options.kind == "vf";
  const auto begin = std::chrono::steady_clock::now();
  for (const Query& query : queries)
    answers.push_back(vertex_face ? test.vertex_face(as_vertex_face(query))
                                  : test.edge_edge(as_edge_edge(query)));
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;

  Summary summary;
  json rows = json::array();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    summary.add(answers[i], queries[i].truth);
    json row = {{"verdict", to_string(answers[i].verdict)}, {"time", nullptr}, {"truth", nullptr}};
    if (answers[i].verdict != Verdict::apart) row["time"] = answers[i].time;
    if (queries[i].truth) row["truth"] = *queries[i].truth;
    rows.push_back(std::move(row));
  }
  const double ns_mean = spent.count() / static_cast<double>(queries.size());
  const json document = {{"schema", "cscd.elementary/1"},
                         {"input", options.file},
                         {"kind", options.kind},
                         {"elementary", test.name},
                         {"answers", std::move(rows)},
                         {"summary",
                          {{"queries", summary.queries},
                           {"contacts", summary.contacts},
                           {"undecided", summary.undecided},
                           {"with_truth", summary.with_truth},
                           {"false_positives", summary.false_positives},
                           {"false_negatives", summary.false_negatives},
                           {"ns_mean", ns_mean}}}};
  if (output) output->commit(document.dump(1) + "\n");
  std::printf(
      "%s (%s, %s): %zu queries, %zu contacts, %zu undecided; of %zu with truth %zu false positives, %zu "
      "false negatives; %.0f ns a query\n",
      options.file.c_str(), options.kind.c_str(), std::string(test.name).c_str(), summary.queries,
      summary.contacts, summary.undecided, summary.with_truth, summary.false_positives,
      summary.false_negatives, ns_mean);
}

}  // namespace

void add_elementary(CLI::App& app) {
  auto options = std::make_shared<ElementaryOptions>();
  CLI::App* command = app.add_subcommand(
      "elementary",
      "Run an elementary test over a file of queries in the public format.\n\n"
      "  cscd elementary data_0_0.csv --kind vf --elementary newton\n\n"
      "Eight rows a query, x_num,x_den,y_num,y_den,z_num,z_den[,truth]: four points at t = 0, then at t = "
      "1.\n"
      "vf: the vertex, then the triangle's corners. ee: the first edge's ends, then the second's.");
  command->add_option("file", options->file, "the queries, CSV")->required();
  command->add_option("--kind", options->kind, "vf or ee")->required()->check(CLI::IsMember({"vf", "ee"}));
  command->add_option("--elementary", options->elementary, "elementary test (cscd list tests)")
      ->capture_default_str();
  command->add_option("--json", options->output, "where every answer goes");
  command->add_flag("--force", options->force, "replace the output if it exists");
  command->callback([options] { run_elementary(*options); });
}

}  // namespace cscd::bench
