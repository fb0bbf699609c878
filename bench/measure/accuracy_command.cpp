#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/measure/studies/tally.h"
#include "bench/measure/studies/workload.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/output/schema.h"
#include "bench/records/environment.h"
#include "bench/statistics/statistics.h"
#include "bench/strategies/catalogue.h"

// The study: what accuracy costs in time, elementary test by elementary test (schema cscd.accuracy/1).
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct AccuracyOptions {
  std::vector<std::string> scenes;
  std::string set, elementary = "all", sweep, output;
  std::vector<double> hardnesses;
  std::size_t every = 1, scene_queries = 0, open_queries = 0, hard_queries = 0, close_queries = 0,
              random_queries = 0, sweep_queries = 0, seed = 1;
  int passes = 3;
  bool smoke = false, force = false;
};

// Fills in every option that the user left open, for the small or the full size. Given options stay.
void choose_size(AccuracyOptions& options) {
  const bool smoke = options.smoke;
  const auto number = [&](std::size_t& value, std::size_t small, std::size_t large) {
    if (value == 0) value = smoke ? small : large;
  };
  number(options.scene_queries, 1000, 10'000'000);
  number(options.open_queries, 200, 10'000'000);
  number(options.hard_queries, 60, 20'000);
  number(options.close_queries, 60, 20'000);
  number(options.random_queries, 20, 2000);
  number(options.sweep_queries, 20, 2000);
  if (options.hardnesses.empty())
    options.hardnesses = smoke ? std::vector{1e-2, 1e-8, 1e-14}
                               : std::vector{1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16};
}

std::span<const OptionRow<AccuracyOptions>> accuracy_options() {
  using A = AccuracyOptions;
  static const OptionRow<A> rows[] = {
      {"--scene", &A::scenes, "scenes whose pairs are asked (cscd list scenes)"},
      {"--every", &A::every, "of their intervals, each K-th", {{1, 1'000'000}}},
      {"--set", &A::set, "folder of the open query set, with its index.csv"},
      {"--elementary", &A::elementary,
       "tests with commas between them, or all; NAME@TOLERANCE[:STEPS] chooses parameters"},
      {"--sweep", &A::sweep,
       "further tests that see the first queries of every workload alone, but for the random families"},
      {"--sweep-queries", &A::sweep_queries, "how many those are"},
      {"--scene-queries", &A::scene_queries, "at most, of each scene and kind"},
      {"--open-queries", &A::open_queries, "at most, of each folder and kind"},
      {"--hard-queries", &A::hard_queries, "of each family and kind"},
      {"--close-queries", &A::close_queries, "of each family at a distance and kind"},
      {"--random-queries", &A::random_queries, "of each family, kind and hardness"},
      {"--hardness",
       &A::hardnesses,
       "how far the points of random queries are moved off a lattice, as shares of a query's size",
       {{1e-18, 1}}},
      {"--passes", &A::passes, "how often every test is asked the same block", {{1, 1000}}},
      {"--seed", &A::seed, "of the queries and of the order of the tests"},
      {"--smoke", &A::smoke, "seconds instead of minutes; times mean nothing"}};
  return rows;
}

// With everything that was left open filled in, so it does not say --smoke.
std::vector<std::string> command_line(AccuracyOptions options) {
  options.set = std::filesystem::path(options.set).filename();  // not where it lies on this machine
  options.smoke = false;
  std::vector<std::string> words = {"cscd", "accuracy"};
  echo_options<AccuracyOptions>(accuracy_options(), options, words);
  return words;
}

ordered_json row_json(const ElementaryTest& test) {
  ordered_json row = {{"name", test.name},
                      {"source", test.source},
                      {"apart_is_proof", test.apart_is_proof},
                      {"contact_is_proof", test.contact_is_proof}};
  if (test.parameters.tolerance >= 0) row["tolerance"] = test.parameters.tolerance;
  if (test.parameters.steps >= 0) row["steps"] = test.parameters.steps;
  return row;
}

constexpr std::array<const char*, 4> kStageNames = {"filter", "doubles", "integers", "referee"};

class Study {
 public:
  explicit Study(const AccuracyOptions& options)
      : options_(options), random_(options.seed), tests_(elementary_tests_named(options.elementary)) {
    whole_ = tests_.size();
    if (!options.sweep.empty())
      for (const ElementaryTest* test : elementary_tests_named(options.sweep)) tests_.push_back(test);
    totals_.resize(tests_.size());
    close_totals_.resize(tests_.size());
  }

  void run(Workload& workload) {
    const bool at_distance = workload.at_distance();
    std::vector<Tally> tallies(tests_.size());
    // At a distance, tests that know none are left out.
    std::vector<const ElementaryTest*> asked;
    std::vector<Tally*> places;
    std::size_t whole = 0;
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      if (at_distance && !tests_[i]->knows_distance()) continue;
      asked.push_back(tests_[i]), places.push_back(&tallies[i]);
      if (i < whole_) whole = asked.size();
    }
    std::vector<Question> block;
    std::vector<Truth> truths;
    std::array<std::size_t, 3> nearness{};
    std::array<std::size_t, kStageNames.size()> stages{};
    std::size_t queries = 0;
    for (workload.next(block); !block.empty(); workload.next(block)) {
      truths.clear();
      for (const Question& question : block) {
        truths.push_back(truth_of(question, workload.kind));
        ++nearness[static_cast<std::size_t>(truths.back().nearness)];
        ++stages[static_cast<std::size_t>(stage_of(question, workload.kind))];
        const std::optional<bool>& published = question.query.truth;
        published_ += published.has_value();
        contradicted_ += published && *published != truths.back().contact.has_value();
      }
      // The rows of the sweep are many and slow. They see the first queries of each workload alone, and none
      // of workloads with a hardness.
      const bool all = !workload.hardness && queries < options_.sweep_queries;
      const std::size_t rows = all ? asked.size() : whole;
      const std::size_t seen = all ? std::min(block.size(), options_.sweep_queries - queries) : block.size();
      const auto part = [&](std::size_t first, std::size_t count, std::size_t row_count) {
        if (count > 0)
          measure(std::span(block).subspan(first, count), std::span(truths).subspan(first, count),
                  workload.kind, std::span(asked).first(row_count), options_.passes, random_,
                  std::span(places).first(row_count));
      };
      part(0, seen, rows);
      part(seen, block.size() - seen, whole);
      queries += block.size();
    }
    ordered_json rows = ordered_json::array();
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      if (at_distance && !tests_[i]->knows_distance()) continue;
      const Tally& tally = tallies[i];
      ordered_json row = {{"row", tests_[i]->name}};
      row.update(tally.json());
      rows.push_back(std::move(row));
      if (tally.breaks(*tests_[i]))
        broken_.push_back(std::string(tests_[i]->name) + " on " + workload.group + " " + workload.name + " " +
                          kind_name(workload.kind) + ": " + std::to_string(tally.false_negatives) +
                          " false negatives, " + std::to_string(tally.false_positives) +
                          " false positives, latest time by " + ordered_json(tally.largest_late).dump());
      (at_distance ? close_totals_ : totals_)[i].add(tally);
    }
    ordered_json out = {
        {"group", workload.group}, {"name", workload.name}, {"kind", kind_name(workload.kind)}};
    if (workload.hardness) out["hardness"] = *workload.hardness;
    out["queries"] = queries;
    for (std::size_t k = 0; k < nearness.size(); ++k) out[kNearnessNames[k]] = nearness[k];
    for (std::size_t k = 0; k < stages.size(); ++k) out["stages"][kStageNames[k]] = stages[k];
    out["rows"] = std::move(rows);
    workloads_.push_back(std::move(out));
    if (!at_distance) keep_pairs(workload, tallies);
  }

  bool kept() const { return broken_.empty() && contradicted_ == 0; }

  ordered_json json() const {
    ordered_json rows = ordered_json::array(), totals = ordered_json::array();
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      rows.push_back(row_json(*tests_[i]));
      rows.back()["sweep"] = i >= whole_;
      ordered_json total = {{"row", tests_[i]->name}};
      total.update(totals_[i].json());
      totals.push_back(std::move(total));
    }
    return {{"schema", "cscd.accuracy/1"},
            {"environment", environment()},
            {"command", command_line(options_)},
            {"seed", options_.seed},
            {"passes", options_.passes},
            {"promises", {{"ok", kept()}, {"broken", broken_}}},
            {"published_truths", {{"queries", published_}, {"contradicted", contradicted_}}},
            {"rows", std::move(rows)},
            {"totals", std::move(totals)},
            {"ratios", ratios()},
            {"workloads", workloads_}};
  }

  void print() const {
    std::printf("%-24s %6s %10s %9s %9s %9s %10s %9s %9s %9s %10s %9s\n", "test", "proof", "queries",
                "contacts", "false neg", "false pos", "undecided", "far ns", "near ns", "contact",
                "at r wrong", "at r ns");
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      const Tally &t = totals_[i], &close = close_totals_[i];
      const auto ns = [&](std::size_t k) { return t.ns[k].empty() ? 0.0 : mean(t.ns[k]); };
      std::printf("%-24s %6s %10zu %9zu %9zu %9zu %10zu %9.0f %9.0f %9.0f",
                  std::string(tests_[i]->name).c_str(),
                  tests_[i]->contact_is_proof ? "both"
                  : tests_[i]->apart_is_proof ? "apart"
                                              : "",
                  t.queries, t.contacts, t.false_negatives, t.false_positives,
                  t.undecided_contacts + t.undecided_apart, ns(0), ns(1), ns(2));
      if (close.queries > 0)
        std::printf(" %10zu %9.0f", close.false_negatives + close.false_positives, ns_of_all(close));
      std::printf("\n");
    }
    for (const ordered_json& ratio : ratios())
      if (!ratio.contains("name"))
        std::printf("time of filtered_exact as a share of newton's, %s: %.3f [%.3f, %.3f]\n",
                    ratio["group"].get<std::string>().c_str(), ratio["value"].get<double>(),
                    ratio["low"].get<double>(), ratio["high"].get<double>());
    if (contradicted_ > 0) std::printf("the oracle contradicts %zu published truths\n", contradicted_);
    for (const std::string& line : broken_) std::printf("BROKEN PROMISE: %s\n", line.c_str());
  }

 private:
  // The mean time of a query over all classes.
  static double ns_of_all(const Tally& tally) {
    double sum = 0, queries = 0;
    for (std::size_t k = 0; k < tally.ns.size(); ++k) {
      if (tally.ns[k].empty()) continue;
      sum += mean(tally.ns[k]) * static_cast<double>(tally.timed[k]);
      queries += static_cast<double>(tally.timed[k]);
    }
    return sum / queries;
  }
  static const char* kind_name(Kind kind) { return kind == Kind::vertex_face ? "vf" : "ee"; }

  // Keeps the times that `filtered_exact` and `newton` took for the same blocks, by group and by name in the
  // group; the name "" stands for the whole group.
  void keep_pairs(const Workload& workload, const std::vector<Tally>& tallies) {
    const Tally *exact = nullptr, *newton = nullptr;
    for (std::size_t i = 0; i < whole_; ++i) {
      if (tests_[i]->name == "filtered_exact") exact = &tallies[i];
      if (tests_[i]->name == "newton") newton = &tallies[i];
    }
    if (!exact || !newton) return;
    for (const std::string& name : {std::string(), workload.name}) {
      auto& [a, b] = pairs_[{workload.group, name}];
      a.insert(a.end(), exact->block_ns.begin(), exact->block_ns.end());
      b.insert(b.end(), newton->block_ns.begin(), newton->block_ns.end());
    }
  }
  ordered_json ratios() const {
    ordered_json out = ordered_json::array();
    for (const auto& [key, times] : pairs_) {
      if (times.first.empty()) continue;
      const Estimate ratio = bootstrap_ratio_of_means(times.first, times.second);
      ordered_json one = {{"row", "filtered_exact"}, {"over", "newton"}, {"group", key.first}};
      if (!key.second.empty()) one["name"] = key.second;
      one.update(
          {{"blocks", times.first.size()}, {"value", ratio.value}, {"low", ratio.low}, {"high", ratio.high}});
      out.push_back(std::move(one));
    }
    return out;
  }

  const AccuracyOptions& options_;
  std::mt19937_64 random_;
  std::vector<const ElementaryTest*> tests_;  // first those that see everything, then the sweep
  std::size_t whole_ = 0;
  std::vector<Tally> totals_, close_totals_;  // the latter of queries at a distance
  std::size_t published_ = 0, contradicted_ = 0;
  std::vector<std::string> broken_;
  ordered_json workloads_ = ordered_json::array();
  std::map<std::pair<std::string, std::string>, std::pair<std::vector<double>, std::vector<double>>> pairs_;
};

void run_accuracy(AccuracyOptions options) {
  choose_size(options);
  Study study(options);
  OutputFile output(options.output, options.force);
  std::vector<Workload> workloads = hard_workloads(options.hard_queries, options.seed);
  const auto append = [&](std::vector<Workload> more) {
    for (Workload& workload : more) workloads.push_back(std::move(workload));
  };
  append(close_workloads(options.close_queries, options.seed));
  append(random_workloads(options.hardnesses, options.random_queries, options.seed));
  if (!options.set.empty()) append(open_workloads(options.set, options.open_queries));
  for (const std::string& scene : options.scenes)
    append(scene_workloads(scene, options.every, options.scene_queries));

  Progress progress("accuracy", workloads.size());
  for (Workload& workload : workloads) {
    study.run(workload);
    workload.next = nullptr;  // what it held
    progress.advance();
  }
  const ordered_json record = study.json();
  if (const std::string violation = schema_violation(record, "accuracy.schema.json"); !violation.empty())
    throw std::logic_error("the record does not follow its schema: " + violation);
  output.commit(json_text(record));
  study.print();
  if (!study.kept()) end_with(ExitStatus::failed);
}

}  // namespace

void add_accuracy(CLI::App& app) {
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = app.add_subcommand(
      "accuracy",
      "Measure what elementary tests get wrong and what they cost, on the same queries, against the "
      "oracle.\n\n"
      "  cscd accuracy --smoke\n"
      "  cscd accuracy --scene rope_contact --set QUERIES --sweep cubic@1e-3,cubic@1e-9 --json "
      "record.json\n\n"
      "Asks the hard families (cscd list families), the same at every hardness, families of queries at a\n"
      "distance (of the tests that know distances), the open query set where it is named, and the pairs of\n"
      "scenes that get past bounds and filter. Exit status 1 where a test is wrong in what it proves, or\n"
      "the oracle contradicts a published truth.");
  add_options(*command, accuracy_options(), *options);
  add_output_options(*command, *options, "where the record goes");
  command->callback([options] { run_accuracy(*options); });
}

}  // namespace cscd::bench
