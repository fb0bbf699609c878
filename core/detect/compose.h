#pragma once

#include <memory>

#include "core/detect/carried_pairs.h"
#include "core/detect/culler.h"
#include "core/detect/detector.h"
#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Selects the feature pairs that are dropped because of the signs of their coplanarity cubic. `certain_sign`
// drops a pair only if the sign exceeds its error bound. The others measure what that certainty costs and
// saves: `none` drops nothing, and `plain_sign` ignores the error bound and so loses contacts.
enum class PairFilter { certain_sign, plain_sign, none };

struct PairOptions {
  bool relative_boxes = false;  // drop non-adjacent triangle pairs by their relative boxes first
  PairFilter filter = PairFilter::certain_sign;
  // The feature pairs for which triangle pairs are tested; null tests all that they carry. An assignment is
  // used without relative boxes and with the certain sign, whatever the other options say.
  std::unique_ptr<const FeatureAssignment> assignment = nullptr;
};

// Makes a detector out of a culling strategy and an elementary test. All strategies share the steps after the
// culler: drop triangle pairs by their relative boxes (optional), expand the others into feature pairs, apply
// the non-penetration filter, and give each remaining feature pair to the elementary test once. The detector
// owns the clock of the interval. `mesh` and `test` must outlive the detector.
std::unique_ptr<Detector> compose(std::unique_ptr<Culler> culler, const TriangleMesh& mesh,
                                  const ElementaryTest& test, PairOptions options = {});

}  // namespace cscd
