#include <CLI/App.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/output/output.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/catalogue.h"
#include "scenes/queries/query_file.h"

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

// How one row answered a file.
struct Outcome {
  const ElementaryTest* test;
  std::vector<Answer> answers;
  std::vector<double> ns_mean;  // of each pass
  std::size_t contacts = 0, undecided = 0, with_truth = 0, false_positives = 0, false_negatives = 0;

  void pass(const std::vector<Query>& queries, bool vertex_face) {
    answers.clear();
    answers.reserve(queries.size());
    const auto begin = std::chrono::steady_clock::now();
    for (const Query& query : queries)
      answers.push_back(vertex_face ? test->vertex_face(as_vertex_face(query))
                                    : test->edge_edge(as_edge_edge(query)));
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    ns_mean.push_back(spent.count() / static_cast<double>(queries.size()));
  }
  void count(const std::vector<Query>& queries) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Verdict verdict = answers[i].verdict;
      contacts += verdict == Verdict::contact;
      undecided += verdict == Verdict::undecided;
      if (!queries[i].truth) continue;
      ++with_truth;
      false_positives += verdict == Verdict::contact && !*queries[i].truth;
      false_negatives += verdict == Verdict::apart && *queries[i].truth;
    }
  }
  bool breaks_promise() const {
    return (test->apart_is_proof && false_negatives > 0) || (test->contact_is_proof && false_positives > 0);
  }
};

json to_json(const Outcome& outcome, const std::vector<Query>& queries) {
  json rows = json::array();
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Answer& answer = outcome.answers[i];
    json row = {{"verdict", to_string(answer.verdict)}, {"time", nullptr}, {"truth", nullptr}};
    if (answer.verdict != Verdict::apart) row["time"] = answer.time;
    if (queries[i].truth) row["truth"] = *queries[i].truth;
    rows.push_back(std::move(row));
  }
  return {{"elementary", outcome.test->name},
          {"answers", std::move(rows)},
          {"summary",
           {{"queries", queries.size()},
            {"contacts", outcome.contacts},
            {"undecided", outcome.undecided},
            {"with_truth", outcome.with_truth},
            {"false_positives", outcome.false_positives},
            {"false_negatives", outcome.false_negatives},
            {"ns_mean", median(outcome.ns_mean)}}}};
}

// The rows take turns, so that drift of the machine hits all alike; the time is the median of their passes.
constexpr int kPasses = 3;

void run_elementary(const ElementaryOptions& options) {
  std::vector<Outcome> outcomes;
  for (const ElementaryTest* test : elementary_tests_named(options.elementary))
    outcomes.emplace_back().test = test;
  OutputFile output(options.output, options.force);
  const std::vector<Query> queries = read_queries(options.file);

  for (int pass = 0; pass < kPasses; ++pass)
    for (Outcome& outcome : outcomes) outcome.pass(queries, options.kind == "vf");
  bool kept = true;
  std::printf("%s (%s), %zu queries\n%-24s %9s %9s %10s %11s %11s %12s\n", options.file.c_str(),
              options.kind.c_str(), queries.size(), "test", "contacts", "undecided", "with truth",
              "false pos.", "false neg.", "ns a query");
  for (Outcome& outcome : outcomes) {
    outcome.count(queries);
    kept = kept && !outcome.breaks_promise();
    std::printf("%-24s %9zu %9zu %10zu %11zu %11zu %12.0f%s\n", std::string(outcome.test->name).c_str(),
                outcome.contacts, outcome.undecided, outcome.with_truth, outcome.false_positives,
                outcome.false_negatives, median(outcome.ns_mean),
                outcome.breaks_promise() ? "  <- promised none" : "");
  }
  json document = {{"schema", "cscd.elementary/1"}, {"input", options.file}, {"kind", options.kind}};
  if (outcomes.size() == 1) {
    document.update(to_json(outcomes.front(), queries));
  } else {
    for (const Outcome& outcome : outcomes) document["tests"].push_back(to_json(outcome, queries));
  }
  output.commit(document.dump(1) + "\n");
  if (!kept) end_with(ExitStatus::failed);
}

}  // namespace

void add_elementary(CLI::App& app) {
  auto options = std::make_shared<ElementaryOptions>();
  CLI::App* command = app.add_subcommand(
      "elementary",
      "Run elementary tests over a file of queries in the public format.\n\n"
      "  cscd elementary data_0_0.csv --kind vf --elementary newton\n"
      "  cscd elementary data_0_0.csv --kind ee --elementary exact,cubic@1e-8,inclusion@1e-4:1000\n"
      "  cscd elementary data_0_0.csv --kind ee --elementary all\n\n"
      "Eight rows a query, x_num,x_den,y_num,y_den,z_num,z_den[,truth]: four points at t = 0, then at t =\n"
      "1. vf: the vertex, then the triangle's corners. ee: the first edge's ends, then the second's. Exit\n"
      "status 1 where a test is wrong in what it proves.");
  using E = ElementaryOptions;
  static const OptionRow<E> rows[] = {
      required<E>({"file", &E::file, "the queries, CSV"}),
      {.name = "--kind", .member = &E::kind, .help = "vf or ee", .choices = {"vf", "ee"}, .required = true},
      {"--elementary", &E::elementary,
       "tests with commas between them (cscd list tests), or all; NAME@TOLERANCE[:STEPS] chooses "
       "parameters"}};
  add_options<E>(*command, rows, *options);
  add_output_options(*command, *options, "where every answer goes");
  command->callback([options] { run_elementary(*options); });
}

}  // namespace cscd::bench
