// `newton` and `filtered_exact` side by side on the same queries, in turns:
//   cscd_kernels --benchmark_filter=elementary/rope_contact
//   CSCD_QUERIES=../shared/queries cscd_kernels --benchmark_filter=elementary/queries
// Of a scene, from eight of its intervals: `query`, the feature pairs that the filter leaves of what the
// default strategy passes on (what `cscd query` spends its time on); `reference`, the same of the complete
// reference; `unfiltered`, every sixteenth feature pair of the reference before the filter. Counters:
// nanoseconds a query of either, their ratio with its 10 % and 90 % points over the turns, and by which stage
// filtered_exact decided.
#include "bench/measure/kernels/elementary.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/measure/strategies/catalogue.h"
#include "bench/query/input/input.h"
#include "core/detect/carried_pairs.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/certified/filtered_exact.h"
#include "scenes/catalog/scene.h"
#include "scenes/queries/query_file.h"

namespace cscd::bench {
namespace {

struct Queries {
  std::vector<MovingVertexFace> vertex_face;
  std::vector<MovingEdgeEdge> edge_edge;
  std::size_t size() const { return vertex_face.size() + edge_edge.size(); }
};

// A row that keeps what it is asked. Rows are plain functions, so it has one place for that.
Queries* kept = nullptr;
const ElementaryTest kKeep{"keep",
                           "",
                           false,
                           false,
                           one_by_one<[](const MovingVertexFace& query) {
                             kept->vertex_face.push_back(query);
                             return Answer{Verdict::apart, 0};
                           }>,
                           one_by_one<[](const MovingEdgeEdge& query) {
                             kept->edge_edge.push_back(query);
                             return Answer{Verdict::apart, 0};
                           }>};

class EverySixteenth : public TrianglePairSink {
 public:
  EverySixteenth(const TriangleMesh& mesh, const Motion& motion, Queries& out)
      : mesh_(mesh), motion_(motion), out_(out) {}

 private:
  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block)
      for_each_carried(mesh_, pair, [&](const FeaturePair& features) {
        if (seen_++ % 16 != 0) return;
        if (features.kind == FeaturePair::Kind::vertex_face)
          out_.vertex_face.push_back(
              vertex_face(mesh_, motion_, VertexId{features.a}, TriangleId{features.b}));
        else
          out_.edge_edge.push_back(edge_edge(mesh_, motion_, EdgeId{features.a}, EdgeId{features.b}));
      });
  }
  const TriangleMesh& mesh_;
  const Motion& motion_;
  Queries& out_;
  std::size_t seen_ = 0;
};

enum class Source { query, reference, unfiltered };

Queries of_scene(const std::string& scene, Source source) {
  Queries result;
  kept = &result;
  Input input = open_input(scene);
  const StrategyInput setup = input.setup(kKeep);
  const Strategy& strategy = source == Source::query ? default_strategy(input, true) : complete_reference();
  const Prepared prepared = strategy.make(setup);
  PlainCuller<Kdop16> culler(setup);
  ContactSet contacts;
  const std::size_t count = input.clip->interval_count();
  for (std::size_t k = 0; k < 8; ++k) {
    const scenes::ClipInterval interval = input.clip->load((2 * k + 1) * count / 16);
    if (source == Source::unfiltered) {
      EverySixteenth sink(input.mesh, interval.motion, result);
      culler.refit({interval.motion});
      culler.cull(sink);
      sink.flush();
    } else {
      prepared.detector->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, contacts);
    }
  }
  return result;
}

// Files under one folder of the public query set.
Queries of_folder(const std::filesystem::path& folder) {
  Queries result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    const bool edges = entry.path().string().find("edge-edge") != std::string::npos ||
                       entry.path().stem().string().ends_with("ee");
    for (const Query& query : read_queries(entry.path()))
      if (edges)
        result.edge_edge.push_back(as_edge_edge(query));
      else
        result.vertex_face.push_back(as_vertex_face(query));
  }
  return result;
}

double nanoseconds(const ElementaryTest& test, const Queries& queries) {
  const auto begin = std::chrono::steady_clock::now();
  for (const MovingVertexFace& query : queries.vertex_face) benchmark::DoNotOptimize(test.vertex_face(query));
  for (const MovingEdgeEdge& query : queries.edge_edge) benchmark::DoNotOptimize(test.edge_edge(query));
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

void in_turns(benchmark::State& state, const Queries& queries) {
  if (queries.size() == 0) {
    state.SkipWithError("no pairs");
    return;
  }
  const ElementaryTest &newton = elementary_test_named("newton"),
                       &exact = elementary_test_named("filtered_exact");
  const double size = static_cast<double>(queries.size());
  double sums[2] = {0, 0};
  std::vector<double> ratios;
  for (auto _ : state) {
    const bool first = ratios.size() % 2 == 0;
    double spent[2];
    spent[first ? 0 : 1] = nanoseconds(first ? newton : exact, queries);
    spent[first ? 1 : 0] = nanoseconds(first ? exact : newton, queries);
    for (int i = 0; i < 2; ++i) sums[i] += spent[i];
    ratios.push_back(spent[1] / spent[0]);
  }
  std::sort(ratios.begin(), ratios.end());
  const double turns = static_cast<double>(ratios.size());
  state.counters["pairs"] = size;
  state.counters["newton_ns"] = sums[0] / turns / size;
  state.counters["exact_ns"] = sums[1] / turns / size;
  state.counters["ratio"] = sums[1] / sums[0];
  state.counters["ratio_p10"] = ratios[ratios.size() / 10];
  state.counters["ratio_p90"] = ratios[ratios.size() - 1 - ratios.size() / 10];
  std::map<ExactStage, double> stages;
  double contacts = 0;
  const auto count = [&](const auto& all, auto test) {
    for (const auto& query : all) {
      ++stages[filtered_exact_stage(query)];
      contacts += test(query).verdict == Verdict::contact;
    }
  };
  count(queries.vertex_face, filtered_exact_vertex_face);
  count(queries.edge_edge, filtered_exact_edge_edge);
  state.counters["contacts"] = contacts;
  state.counters["by_filter"] = stages[ExactStage::filter];
  state.counters["by_doubles"] = stages[ExactStage::doubles];
  state.counters["by_integers"] = stages[ExactStage::integers];
  state.counters["by_referee"] = stages[ExactStage::referee];
}

}  // namespace

void register_elementary() {
  const std::pair<Source, const char*> sources[] = {
      {Source::query, "query"}, {Source::reference, "reference"}, {Source::unfiltered, "unfiltered"}};
  for (const scenes::SceneSummary& scene : scenes::list_scenes())
    for (const auto& [source, name] : sources)
      benchmark::RegisterBenchmark(("elementary/" + scene.name + "/" + name).c_str(),
                                   [scene = scene.name, source = source](benchmark::State& state) {
                                     in_turns(state, of_scene(scene, source));
                                   })
          ->Unit(benchmark::kMillisecond);
  const char* set = std::getenv("CSCD_QUERIES");
  if (set == nullptr) return;
  const auto add = [](const std::filesystem::path& folder, const std::string& name) {
    benchmark::RegisterBenchmark(("elementary/queries/" + name).c_str(), [folder](benchmark::State& state) {
      in_turns(state, of_folder(folder));
    })->Unit(benchmark::kMillisecond);
  };
  for (const char* group : {"handcrafted", "simulation", "simulation-derived"})
    if (std::filesystem::exists(std::filesystem::path(set) / group))
      add(std::filesystem::path(set) / group, group);
  const std::filesystem::path hard = std::filesystem::path(set) / "hard";
  if (std::filesystem::exists(hard))
    for (const auto& family : std::filesystem::directory_iterator(hard))
      add(family.path(), "hard/" + family.path().filename().string());
}

}  // namespace cscd::bench
