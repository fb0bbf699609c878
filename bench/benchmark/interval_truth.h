#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/benchmark/pair_name.h"
#include "core/detect/detector.h"
#include "core/elementary/exact/time_enclosure.h"
#include "scenes/clip/mesh_file.h"

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
// the referee. `id` stays empty.
IntervalTruth find_truth(const TriangleMesh& mesh, const scenes::PosedMesh& posed, std::size_t interval);

// A line of truth.jsonl (benchmark_truth.schema.json).
nlohmann::ordered_json to_json(const IntervalTruth& truth);
// Throws InputError, which `where` begins, for anything that to_json does not write.
IntervalTruth truth_from_json(const nlohmann::ordered_json& line, const std::string& where);

}  // namespace cscd::bench
