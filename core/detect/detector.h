#pragma once

#include <optional>

#include "core/detect/contact.h"
#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"

namespace cscd {

// Milliseconds of one interval. A stage that a strategy does not have is absent, not zero.
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

// Finds the contacts of one interval, whose positions are finite numbers. After its second call nothing in
// here allocates unless an interval is larger than all before it; nothing logs or throws.
class Detector {
 public:
  virtual ~Detector() = default;
  virtual Report detect(const Motion& motion, const Rig::Interval* bones, ContactSet& out) = 0;
  virtual RadialView radial_view() const { return {}; }

  // For callers who want the earliest contact and no others, such as a response that cuts the step there.
  // From the next interval on, triangle pairs that certainly do not touch until after the earliest contact
  // found so far are neither filtered nor tested. Which contacts are reported beside those of the earliest
  // time is then left to chance: `keep_first` drops them. What the strategy promises of the earliest time
  // stays, provided that the elementary test is right in both its answers. (A strategy that assigns features
  // to triangle pairs tests all that it assigns.) False for a detector that tests pairs by itself: it goes on
  // finding all.
  virtual bool look_for_first_only() { return false; }
};

}  // namespace cscd
