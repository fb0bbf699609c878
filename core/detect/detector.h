#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/detect/contact.h"
#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"

namespace cscd {

// The time of each stage of one interval, in milliseconds. A stage that a strategy does not have is
// absent; it is not counted as zero.
struct StageTimes {
  double refit = 0;
  std::optional<double> rv_update;
  double traversal = 0;
  double elementary = 0;
  double total() const { return refit + rv_update.value_or(0) + traversal + elementary; }
};

// Two different triangles of one mesh, the smaller index first.
using CrossingPair = std::pair<TriangleId, TriangleId>;

// The triangle pairs that cross in one pose. Two triangles *cross* if they meet outside the vertices and
// edges that they share.
struct Crossings {
  std::vector<CrossingPair> pairs;  // sorted; incomplete if more pairs cross than the caller wanted to keep
  std::size_t total = 0;            // number of all pairs that cross

  bool all_kept() const { return pairs.size() == total; }
  bool contains(const CrossingPair& pair) const { return std::ranges::binary_search(pairs, pair); }
};

struct Report {
  CullCounts cull;
  PairCounts pairs;
  StageTimes ms;
  double start_ms = 0;  // what the exact test of pairs that may cross at the start took; outside of `ms`
};

// Finds the contacts of one interval after another. A detector whose strategy promises it (Strategy::settles)
// allocates no memory once it has seen its largest interval, unless it cuts clusters anew
// (Strategy::follows).
class Detector {
 public:
  virtual ~Detector() = default;
  // Replaces the content of `out` by the contacts and undecided feature pairs of one interval, unsorted, and
  // returns counters and times. All positions must be finite. `bones` holds the skeleton at both ends of the
  // interval; it is null for a mesh without a rig. A detector logs nothing; it throws only where a package
  // that it calls fails or refuses the positions (baselines/embree, baselines/fcl).
  virtual Report detect(const Motion& motion, const Rig::Interval* bones, ContactSet& out) = 0;
  // Does what detect() does, for an interval whose start the caller knows to be embedded (rule
  // embedded-start, core/soundness.md). A complete strategy may then take less time, and finds the same
  // contacts.
  virtual Report detect_from_embedded(const Motion& motion, const Rig::Interval* bones, ContactSet& out) {
    return detect(motion, bones, out);
  }
  // Does what detect() does, and also finds which triangles cross at the start: it tests exactly, in that
  // pose, the pairs of triangles that the culling passes on. At most `most` crossing pairs are kept. Throws
  // std::logic_error where the strategy does not promise it (Strategy::sees_start).
  virtual Report detect_and_see_start(const Motion& /*motion*/, const Rig::Interval* /*bones*/,
                                      ContactSet& /*out*/, std::size_t /*most*/, Crossings& /*start*/) {
    throw std::logic_error("this detector does not see what crosses at a start");
  }
  // Forgets all intervals: what follows is answered as by a new detector. Only the detectors of strategies
  // that follow the surface (Strategy::follows) have anything to forget.
  virtual void forget() {}
  // Returns what preparation has found out about the surface, for Setup::preparation of another detector.
  // Empty for strategies whose preparation takes no time worth saving.
  virtual std::vector<std::byte> saved_preparation() const { return {}; }
  virtual RadialView radial_view() const { return {}; }
};

}  // namespace cscd
