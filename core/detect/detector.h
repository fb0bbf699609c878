#pragma once

#include <optional>

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

struct Report {
  CullCounts cull;
  PairCounts pairs;
  StageTimes ms;
};

// Finds the contacts of one interval after another. A detector whose strategy promises it (Strategy::settles)
// allocates no memory once it has seen its largest interval.
class Detector {
 public:
  virtual ~Detector() = default;
  // Replaces the content of `out` by the contacts and undecided feature pairs of one interval, unsorted, and
  // returns counters and times. All positions must be finite. `bones` holds the skeleton at both ends of the
  // interval; it is null for a mesh without a rig. A detector logs nothing; it throws only where a package
  // that it calls fails or refuses the positions (baselines/embree, baselines/fcl).
  virtual Report detect(const Motion& motion, const Rig::Interval* bones, ContactSet& out) = 0;
  virtual RadialView radial_view() const { return {}; }
};

}  // namespace cscd
