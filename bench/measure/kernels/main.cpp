#include <algorithm>
#include <benchmark/benchmark.h>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/inputs/input.h"
#include "bench/strategies/catalogue.h"
#include "core/detect/carried_pairs.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/certified/filtered_exact.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/overlap_descent.h"
#include "core/radial/orientation.h"
#include "scenes/catalog/scene.h"
#include "scenes/queries/query_file.h"

// The inner loops of one interval by themselves, on a middle frame of the rope:
//   cscd_kernels --benchmark_filter=refit
// For work on a kernel; what `cscd run` records is measured there.
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
  std::ranges::sort(ratios);
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
  state.counters["by_oracle"] = stages[ExactStage::oracle];
}

// The benchmarks elementary/SCENE/... and, where CSCD_QUERIES names the query set, elementary/queries/....
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

struct Scene {
  Input input = open_input("rope");
  std::vector<Vec3> start, end;
  Tree tree = build_tree(input.mesh, input.reference);

  Scene() {
    const scenes::ClipInterval interval = input.clip->load(input.clip->interval_count() / 2);
    start.assign(interval.motion.start().begin(), interval.motion.start().end());
    end.assign(interval.motion.end().begin(), interval.motion.end().end());
  }
  Motion motion() const { return {start, end}; }
};

const Scene& scene() {
  static const Scene scene;
  return scene;
}

void copy_positions(benchmark::State& state) {
  std::vector<Vec3> start(scene().start.size()), end(start.size());
  for (auto _ : state) {
    std::copy(scene().start.begin(), scene().start.end(), start.begin());
    std::copy(scene().end.begin(), scene().end.end(), end.begin());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(copy_positions)->Unit(benchmark::kMicrosecond);

void vertex_bounds(benchmark::State& state) {
  std::vector<Kdop16> bounds(scene().start.size());
  for (auto _ : state) {
    swept_vertex_bounds(scene().motion(), bounds);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(vertex_bounds)->Unit(benchmark::kMicrosecond);

void vertex_bounds_scalar(benchmark::State& state) {
  std::vector<Kdop16> bounds(scene().start.size());
  const Motion motion = scene().motion();
  for (auto _ : state) {
    for (std::size_t v = 0; v < bounds.size(); ++v)
      bounds[v] = kdop_of(motion[VertexId{static_cast<std::int32_t>(v)}]);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(vertex_bounds_scalar)->Unit(benchmark::kMicrosecond);

void refit(benchmark::State& state) {
  SweptBounds bounds(scene().input.mesh, scene().tree);
  for (auto _ : state) {
    bounds.refit(scene().motion());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(refit)->Unit(benchmark::kMicrosecond);

void self_descent_of_everything(benchmark::State& state) {
  const Tree& tree = scene().tree;
  SweptBounds bounds(scene().input.mesh, tree);
  bounds.refit(scene().motion());
  std::size_t pairs = 0, tests = 0;
  for (auto _ : state)
    tests += self_descent(
        tree, bounds, 0, [&](NodeIndex node) { return tree.is_leaf(node); },
        [](NodeIndex, NodeIndex) { return false; }, [&](NodeIndex, NodeIndex) { ++pairs; });
  state.counters["overlap_tests"] =
      benchmark::Counter(static_cast<double>(tests), benchmark::Counter::kAvgIterations);
  state.counters["pairs"] =
      benchmark::Counter(static_cast<double>(pairs), benchmark::Counter::kAvgIterations);
}
BENCHMARK(self_descent_of_everything)->Unit(benchmark::kMicrosecond);

// All triangles towards one point: gathering once an interval, and one observer.
std::vector<std::vector<TriangleId>> one_group() {
  std::vector<TriangleId> all;
  for (std::size_t t = 0; t < scene().input.mesh.triangle_count(); ++t)
    all.push_back(TriangleId{static_cast<std::int32_t>(t)});
  return {all};
}

void orientation_gather(benchmark::State& state) {
  radial::OrientationTable table(scene().input.mesh, one_group());
  for (auto _ : state) {
    table.update(scene().motion());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(orientation_gather)->Unit(benchmark::kMicrosecond);

void orientation_of_one_point(benchmark::State& state) {
  radial::OrientationTable table(scene().input.mesh, one_group());
  table.update(scene().motion());
  const auto observer = radial::Observer::point({scene().start[0], scene().end[0]});
  std::vector<radial::Orientation> classes(scene().input.mesh.triangle_count());
  for (auto _ : state) {
    table.classify(0, observer, classes);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(orientation_of_one_point)->Unit(benchmark::kMicrosecond);

}  // namespace

}  // namespace cscd::bench
int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    cscd::bench::register_elementary();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cscd_kernels: %s\n", error.what());
    return 2;
  }
}
