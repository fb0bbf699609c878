#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/pipeline.h"
#include "core/detect/detector.h"
#include "core/elementary/question/elementary_test.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

class Exclusions;

// What a strategy promises (core/soundness.md). `complete`: on every input, every feature pair in contact is
// passed on to the elementary test. `first_contact`: on a closed, consistently oriented mesh with an embedded
// start, at least one feature pair that attains the earliest contact time is passed on; later contacts may be
// missing. `all_from_embedded`: on such a mesh with such a start, all of them, provided that the elementary
// test takes no contact for apart. `heuristic`: nothing.
enum class Guarantee { complete, first_contact, all_from_embedded, heuristic };
// Whether a guarantee promises nothing from a start that is not embedded.
constexpr bool needs_embedded_start(Guarantee guarantee) {
  return guarantee == Guarantee::first_contact || guarantee == Guarantee::all_from_embedded;
}
// Whether a guarantee promises all contacts from such a start.
constexpr bool promises_all(Guarantee guarantee, bool starts_embedded) {
  return guarantee == Guarantee::complete || (guarantee == Guarantee::all_from_embedded && starts_embedded);
}
// Returns the name of the enumerator.
std::string_view to_string(Guarantee guarantee);

// What a strategy needs to make a detector. The referenced objects must outlive the detector.
struct StrategyInput {
  const TriangleMesh& mesh;
  std::span<const Vec3> reference;  // [vertices]; positions in the reference pose (frame 0)
  const Rig* rig;                   // null for a mesh without bones
  const ElementaryTest& elementary;
  // The number of threads that answer one interval, the caller's included; at least 1. Strategies that cannot
  // share their work run on one thread. Answers and counters do not depend on the number.
  int threads = 1;
  // For a caller who wants the earliest contact and no others, such as a response that cuts the step there. A
  // triangle pair that certainly does not touch until after the earliest contact found so far is then neither
  // filtered nor tested. The strategy's promise about the earliest time still holds, provided that the
  // elementary test is right in both its answers. Later contacts are reported by chance; keep_first()
  // (contact.h) drops them. A strategy that brings its own elementary test throws InputError.
  bool first_only = false;
  // Feature pairs that do not count as contacts; null for none. They are dropped before they are tested. The
  // guarantee `first_contact` is void with exclusions, because the surface may then pass through itself;
  // `all_from_embedded` then holds from any start. A
  // strategy that brings its own elementary test throws InputError.
  const Exclusions* exclusions = nullptr;
  // A strategy whose kind is not `published` knows the pipeline `vectorised` alone and takes no notice.
  Pipeline pipeline = Pipeline::vectorised;
  // What a detector of the same strategy and surface has said by Detector::saved_preparation(); empty to
  // prepare from nothing. The surface may have changed in places since, and only those are then prepared
  // anew. The strategy throws InputError if it is damaged, or if less than half of the triangles were there.
  // Strategies that save nothing take no notice.
  std::span<const std::byte> preparation = {};
  // The part that each vertex belongs to, [vertices], such as the bone that it follows most; empty where no
  // parts are known. Any integers; parts turn against each other where they meet. They help to choose where
  // to look from, as bones do, and answers do not depend on them. With a rig they are not looked at.
  std::span<const std::int32_t> labels = {};
};

// Results and times of the one-time work before the first interval, in milliseconds (Table 1 of the paper).
struct Preparation {
  std::optional<double> distance_and_heat_ms;  // distance field and heat diffusion
  std::optional<double> decomposition_ms;      // clusters from heat weights, observers
  std::vector<std::int32_t> atomic_cluster;    // [triangles]; empty for a strategy without clusters
  int atomic_clusters = 0;
  int threads = 1;                // the number of threads that the strategy makes use of
  std::size_t new_triangles = 0;  // that StrategyInput::preparation, if given, did not know
};

struct Prepared {
  std::unique_ptr<Detector> detector;
  Preparation preparation;
};

// What an input must have for a strategy to be made. A closed mesh is consistently oriented too.
enum class Needs { any_mesh, closed_mesh, closed_mesh_with_bones };

// What the detectors of a strategy do with memory and with earlier intervals.
enum class StrategyKind {
  fixed,      // once it has seen its largest interval, a detector allocates no memory
  published,  // `fixed`, and made in the pipeline `published` too: the paper's method and those that the
              // paper compares it with
  // A detector cuts its clusters anew as the surface moves, and allocates memory then. What it promises does
  // not depend on the intervals that it has answered before; its counters do, and so do contacts later than
  // the first where no more than that is promised (rule fresh-detector, core/soundness.md).
  adaptive,
  package,  // a library does the work, and allocates memory as it pleases
};

// One row of the catalogue of strategies.
struct Strategy {
  std::string_view name;
  std::string_view source;  // paper or package, in one line
  Guarantee guarantee;
  Needs needs;
  StrategyKind kind;
  // Throws InputError when the setup lacks what the strategy needs.
  Prepared (*make)(const StrategyInput& setup);
  // A row with a group is run only where the row or its group is named; rows without one are run wherever the
  // input allows it.
  std::string_view group = "";
  bool own_test = false;  // brings its own elementary test, whose answers are compared with the oracle's
  // Whether its detectors say which triangles cross at the start (Step::crossings). For that,
  // a pair of triangles may be dropped only by a proof that, at any time of the interval, the two meet
  // nowhere but in what they share. A proof that no feature pair of theirs touches is not enough, because an
  // edge can pierce a face.
  bool sees_start = false;
  // Whether its detectors take steps with a thickness (Step::thickness). The guarantees are then about close
  // pairs, and about clear starts instead of embedded ones.
  bool knows_distance = false;
  // Whether its detectors, told that a start of a closed mesh is embedded, drop pairs by the orientation of
  // triangles alone (Step::starts_embedded), which takes less than half the time.
  bool drops_by_signs = false;
};

}  // namespace cscd
