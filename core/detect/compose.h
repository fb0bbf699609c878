#pragma once

#include <cstddef>
#include <memory>

#include "core/detect/carried_pairs.h"
#include "core/detect/culler.h"
#include "core/detect/strategy.h"

namespace cscd {

struct PairOptions {
  bool relative_boxes = false;  // drop non-adjacent triangle pairs by their relative boxes first
  // Which feature pairs a triangle pair is tested for; null means all that it carries. An assignment is used
  // without relative boxes.
  std::unique_ptr<const FeatureAssignment> assignment = nullptr;
  // The threads that filter and test, for a strategy whose culler uses as many. Contacts, their order and all
  // counters are the same on any number.
  int threads = 1;
  // Every step is taken for one that starts embedded, unless its crossings are wanted.
  bool starts_embedded = false;
  // Where the first contact alone is wanted, a step is tested first for a few feature pairs that touched in
  // the step before, and the culler looks no further than they touch. Counters then depend on earlier steps.
  bool remembers = false;
  // A pair of triangles is tested for the feature pairs that it owns alone (feature_owners.h), where the
  // culler says that this is enough.
  bool owners = false;
  // With a number above 0, loose vertices are held against triangles only where one of the two is among the
  // first so many vertices and the other is not.
  std::size_t own_vertices = 0;
};

// Makes a detector out of a culling strategy and an elementary test: the way of one interval. Every strategy
// shares what happens behind the culler: relative boxes (optional), expansion into feature pairs, each of
// which is tested once, the certified non-penetration filter, and the elementary test. The detector owns the
// clock of the interval. Where a culler has looked for the first contact alone, and anything passed on
// touches or is undecided, it is asked for the rest, unless the caller wants the first contact alone. Loose
// vertices (hierarchy/loose_vertices.h), of which a culler knows nothing, are held against triangles first.
// In the pipeline `published`, the filter is the published one: the plain sign of the coplanarity cubic,
// which may lose contacts because it has no error bound. What `setup` refers to must outlive the detector.
std::unique_ptr<Detector> compose(std::unique_ptr<Culler> culler, const StrategyInput& setup,
                                  PairOptions options = {});

}  // namespace cscd
