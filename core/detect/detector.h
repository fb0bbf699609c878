#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/detect/step.h"

namespace cscd {

// The time of each stage of one interval, in milliseconds. A stage that a strategy does not have is
// absent; it is not counted as zero.
struct StageTimes {
  double refit = 0;
  std::optional<double> classify;  // records call it rv_update, as the paper does
  double traversal = 0;
  double elementary = 0;
  double total() const { return refit + classify.value_or(0) + traversal + elementary; }
};

struct Report {
  CullCounts cull;
  PairCounts pairs;
  StageTimes ms;
  double start_ms = 0;  // what the exact test of pairs that may cross at the start took; outside of `ms`
};

class TrianglePairSink;
namespace fast {
struct PatchTree;  // core/fast/prepare/patches.h
}

// Finds the contacts of one interval after another. The kind of a detector's strategy (StrategyKind) says
// whether the detector allocates memory once it has seen its largest interval. A package may, and so may a
// strategy that cuts clusters anew.
class Detector {
 public:
  virtual ~Detector() = default;
  // Replaces the content of `out` by the contacts and undecided feature pairs of one interval, unsorted, and
  // returns counters and times. A detector logs nothing. It throws InputError where it has no proof for the
  // thickness of the step, and where a package that it calls fails or refuses the positions
  // (baselines/embree, baselines/fcl); and MemoryShortage before the contacts take more memory than there is.
  virtual Report detect(const Step& step, ContactSet& out) = 0;
  // Passes on every triangle pair that is not proven apart in the interval, and tests none. Returns false
  // where the detector has no culler of its own that knows the thickness of the step.
  virtual bool pass_on(const Step& /*step*/, TrianglePairSink& /*sink*/) { return false; }
  // Forgets all intervals: what follows is answered as by a new detector. Only the detectors of strategies
  // that follow the surface (StrategyKind::adaptive) have anything to forget.
  virtual void forget() {}
  // Returns what preparation has found out about the surface, for StrategyInput::preparation of another
  // detector. Empty for strategies whose preparation takes no time worth saving.
  virtual std::vector<std::byte> saved_preparation() const { return {}; }
  // How preparation has cut the surface into patches; null for strategies that know none.
  virtual const fast::PatchTree* patches() const { return nullptr; }
  virtual RadialView radial_view() const { return {}; }
};

}  // namespace cscd
