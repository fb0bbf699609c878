#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/benchmark/benchmark_answers.h"
#include "bench/benchmark/subject.h"
#include "core/detect/detector.h"
#include "core/elementary/exact/time_enclosure.h"
#include "scenes/clip/mesh_file.h"

// A public benchmark: a folder that holds intervals and their exact answers, for any program
// (bench/BENCHMARK.md describes every file).
namespace cscd::bench {

// A feature pair that touches, and two doubles that enclose the earliest time at which it does. They are
// equal where that time is a double, and neighbours otherwise.
struct TrueContact {
  PairName pair;
  exact::TimeEnclosure time;
};

// The exact answer to one interval of the benchmark.
struct IntervalTruth {
  std::string id;
  std::vector<CrossingPair> start_pairs;  // sorted; the triangles that cross at the start
  std::vector<TrueContact> contacts;      // by time, then by pair

  bool starts_embedded() const { return start_pairs.empty(); }
  bool collides() const { return !start_pairs.empty() || !contacts.empty(); }
  std::string_view verdict() const;  // clear, touches or intersects_at_start, as in `cscd query`
  // Encloses the earliest time at which anything touches.
  std::optional<exact::TimeEnclosure> first_time() const;
};

// Finds the exact answer to one interval of a mesh. Meshes of up to 600 triangles are culled by nothing: all
// pairs of triangles are looked at. Larger ones are culled by the complete reference. Contacts are decided by
// the oracle. `id` stays empty.
IntervalTruth find_truth(const TriangleMesh& mesh, const scenes::PosedMesh& posed, std::size_t interval);

// A line of truth.jsonl (benchmark_truth.schema.json).
nlohmann::ordered_json to_json(const IntervalTruth& truth);
// Throws InputError, which `where` begins, for anything that to_json does not write.
IntervalTruth truth_from_json(const nlohmann::ordered_json& line, const std::string& where);

inline constexpr char kBenchmarkSchema[] = "cscd.benchmark/1";
inline constexpr char kManifestName[] = "manifest.json", kTruthName[] = "truth.jsonl",
                      kSumsName[] = "SHA256SUMS";

struct ListedInterval {
  std::string id, family;
  std::string file, mesh;  // the mesh file, and the mesh in it
  std::size_t row = 0;     // of the interval in the arrays `start` and `end` of the mesh
  std::size_t vertices = 0, triangles = 0, bones = 0;
  bool closed = false;  // closed, manifold and consistently oriented
};

struct ListedFile {
  std::string name;
  std::uint64_t bytes = 0;
  std::string sha256;
};

struct Benchmark {
  std::filesystem::path folder;
  std::string sha256;  // of the manifest: the name of this benchmark
  nlohmann::ordered_json made_by;
  std::vector<SubjectFamily> families;
  std::vector<ListedInterval> intervals;
  std::vector<ListedFile> files;  // all but the manifest and the list of checksums

  const SubjectFamily& family(const std::string& name) const;  // of a family that is known to exist
};

struct BenchmarkPlan {
  std::filesystem::path folder;
  std::size_t small = 1000;  // intervals of small meshes
  std::uint64_t seed = 1;
  std::vector<std::string> scenes = {};
  std::size_t scene_intervals = 3;  // of each scene
  bool force = false;               // replace a benchmark that is there
};

// Makes a benchmark, and the folder where it is missing. Equal plans give equal bytes in all files. The
// manifest appears last: a folder without one is no benchmark. `progress` gets the number of intervals done
// and the number of all. Throws InputError where the folder does not take the files.
void make_benchmark(const BenchmarkPlan& plan, const std::function<void(std::size_t, std::size_t)>& progress);

nlohmann::ordered_json to_json(const Benchmark& benchmark);
// The text of SHA256SUMS: the manifest first, then the files in the order of the manifest.
std::string sums_text(const Benchmark& benchmark);

// Reads a manifest and holds every file to its checksum. Throws InputError that names what differs.
Benchmark read_benchmark(const std::filesystem::path& folder);

// The exact answers, in the order of the intervals.
std::vector<IntervalTruth> read_truth(const Benchmark& benchmark);

// Calls `visit` for each mesh with the intervals that it has, as indices into `benchmark.intervals`. Meshes
// come in the order of their first interval, and one is in memory at a time.
void for_each_mesh(const Benchmark& benchmark,
                   const std::function<void(const scenes::PosedMesh&, std::span<const std::size_t>)>& visit);

}  // namespace cscd::bench
