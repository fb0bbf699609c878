#include <benchmark/benchmark.h>
#include <exception>
#include <memory>

#include "bench/measure/kernels/elementary.h"
#include "bench/measure/strategies/catalogue.h"
#include "bench/query/input/input.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/overlap_descent.h"
#include "core/radial/orientation.h"

// The inner loops of one interval by themselves, on a middle frame of the rope:
//   cscd_kernels --benchmark_filter=refit
// For work on a kernel; what `cscd run` records is measured there.
namespace cscd::bench {
namespace {

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
