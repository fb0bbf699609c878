#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/detect/detector.h"
#include "core/elementary/question/elementary_test.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The promise of a strategy about the feature pairs that it passes on to the elementary test:
//   complete        on every input, it passes on every feature pair that is in contact;
//   first_contact   on a closed, consistently oriented mesh with an embedded start, it passes on at least one
//                   feature pair that attains the earliest contact time; later contacts may be missing;
//   heuristic       neither of these.
enum class Guarantee { complete, first_contact, heuristic };
// Returns the name of the enumerator.
std::string_view to_string(Guarantee guarantee);

// The input for which a detector is made. The referenced objects must outlive the detector.
struct Setup {
  const TriangleMesh& mesh;
  std::span<const Vec3> reference;  // [vertices]; positions in the reference pose (frame 0)
  const Rig* rig;                   // null for a mesh without bones
  const ElementaryTest& elementary;
  // Number of threads that answer one interval, the calling thread included; at least 1.
  // Strategies that cannot share out their work run on one thread. Answers and counters are the
  // same for every number of threads.
  int threads = 1;
};

// Results and times of the one-time work before the first interval, in milliseconds (Table 1 of the paper).
struct Preparation {
  std::optional<double> distance_and_heat_ms;  // distance field and heat diffusion
  std::optional<double> decomposition_ms;      // clusters from heat weights, and their observers
  std::vector<std::int32_t> atomic_cluster;    // [triangles]; empty if the strategy has no clusters
  int atomic_clusters = 0;
  int threads = 1;  // number that the detector uses, at most that of the setup
};

struct Prepared {
  std::unique_ptr<Detector> detector;
  Preparation preparation;
};

// One row of the catalogue of strategies.
struct Strategy {
  std::string_view name;
  std::string_view source;  // paper or package, in one line
  Guarantee guarantee;
  bool needs_rig;
  Prepared (*make)(const Setup& setup);  // throws InputError if the setup lacks what the strategy needs
  // Strategies with a group are timed only if they or their group are named. The others are
  // timed wherever the input allows it.
  std::string_view group = "";
  bool own_test = false;  // has an elementary test of its own, whose answers are compared with the referee's
};

}  // namespace cscd
