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

// complete: on every input, every feature pair in contact is passed on to the elementary test.
// first_contact: on a closed, consistently oriented mesh with an embedded start, at least one feature pair
// that attains the earliest contact time is; later contacts may be missing. heuristic: neither.
enum class Guarantee { complete, first_contact, heuristic };
std::string_view to_string(Guarantee guarantee);

// What a strategy is made for. The referenced objects must outlive the detector.
struct Setup {
  const TriangleMesh& mesh;
  std::span<const Vec3> reference;  // vertex positions of the reference pose (frame 0)
  const Rig* rig;                   // null for a mesh without bones
  const ElementaryTest& elementary;
  // Threads that answer one interval, the caller's included; at least 1. Strategies that cannot share their
  // work run on one. Answers and counters do not depend on it.
  int threads = 1;
};

// One-time work before the first interval, as in Table 1 of the paper.
struct Preparation {
  std::optional<double> distance_and_heat_ms;  // distance field and heat diffusion
  std::optional<double> decomposition_ms;      // clusters from heat weights, observers
  std::vector<std::int32_t> atomic_cluster;    // of each triangle; empty where there are none
  int atomic_clusters = 0;
  int threads = 1;  // on which intervals are answered, of those of the setup
};

struct Prepared {
  std::unique_ptr<Detector> detector;
  Preparation preparation;
};

// One row of the catalogue of strategies.
struct Strategy {
  std::string_view name;
  std::string_view source;  // paper or package, in a line
  Guarantee guarantee;
  bool needs_rig;
  Prepared (*make)(const Setup& setup);  // throws InputError when the setup lacks what the strategy needs
  // Rows with a group are timed only where they or their group is named, the others wherever the input allows
  // it.
  std::string_view group = "";
  bool own_test = false;  // brings its own elementary test, whose answers are compared with the referee's
};

}  // namespace cscd
