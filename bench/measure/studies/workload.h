#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/hard/family.h"
#include "scenes/queries/query_file.h"

// The queries of the accuracy study. They come block by block, as there may be millions of them.
namespace cscd::bench {

using Kind = scenes::hard::Kind;

// A query and the distance at which it is asked. At 0 the question is whether the features touch.
struct Question {
  Query query;
  double r = 0;
};

struct Workload {
  std::string group;  // scenes, open, hard, random or close
  std::string name;   // of the scene, the folder of the open set, the family
  Kind kind;
  std::optional<double> hardness;  // of the random families
  // The next queries in `block`, empty when there are no more.
  std::function<void(std::vector<Question>& block)> next;

  bool at_distance() const { return group == "close"; }
};

inline constexpr std::size_t kBlock = 2000;

// The pairs of a scene that get past bounds and filter of the complete reference, on every K-th interval: one
// workload for each kind.
std::vector<Workload> scene_workloads(const std::string& scene, std::size_t every, std::size_t most);
// The open query set, by its folders, with the published truth. Throws InputError where it cannot be read.
std::vector<Workload> open_workloads(const std::filesystem::path& set, std::size_t most);
// The suite, and its families at every hardness of a list.
std::vector<Workload> hard_workloads(std::size_t count, std::uint64_t seed);
// The families at a distance. Only tests that know distances can be asked.
std::vector<Workload> close_workloads(std::size_t count, std::uint64_t seed);
std::vector<Workload> random_workloads(const std::vector<double>& hardnesses, std::size_t count,
                                       std::uint64_t seed);

}  // namespace cscd::bench
