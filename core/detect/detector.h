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

// Finds the contacts of one interval. From its third call on, a detector allocates memory only if an
// interval is larger than all before it.
class Detector {
 public:
  virtual ~Detector() = default;
  // Replaces the content of `out` by the contacts and undecided feature pairs of one interval, unsorted, and
  // returns counters and times. All positions must be finite. `bones` holds the skeleton at both ends of the
  // interval; it is null for a mesh without a rig. A detector logs nothing; it throws only where a package
  // that it calls fails or refuses the positions (baselines/embree, baselines/fcl).
  virtual Report detect(const Motion& motion, const Rig::Interval* bones, ContactSet& out) = 0;
  virtual RadialView radial_view() const { return {}; }

  // Asks for the earliest contact only, as a response needs it that cuts the time step there. From the next
  // interval on, the detector skips triangle pairs that certainly do not touch until after the earliest
  // contact found so far: it neither filters nor tests them. The contacts of later times that are still
  // reported are then left to chance; keep_first() drops them. The strategy's guarantee for the earliest time
  // stays, provided that both "apart" and "contact" of the elementary test are always right.
  //
  // A strategy that assigns feature pairs to triangle pairs goes on testing all that it assigns. Returns
  // false, and goes on finding all contacts, if the detector tests pairs by itself.
  virtual bool look_for_first_only() { return false; }
};

}  // namespace cscd
