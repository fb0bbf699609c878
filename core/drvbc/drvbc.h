#pragma once

#include <string_view>

#include "core/detect/compose.h"
#include "core/detect/strategy.h"
#include "core/radial/bone_clusters.h"
#include "core/radial/orientation.h"

namespace cscd {

// The parameters of the paper, with the paper's values.
struct DrvbcOptions {
  double gamma = 0.05;  // gamma: clusters merge while less than this share of a candidate's triangles is not
                        // positive; 0: never
  radial::BoneClusterOptions bones{};
  bool relative_boxes = true;
  // Rows of the ablation leave one thing out each.
  std::string_view name = "drvbc";  // begins error texts
  bool cache = true;                // keep a cache of triangles that were not positive (section 5)
  radial::SegmentTest segment_test = radial::SegmentTest::all_corners;
  radial::SignTest orientation_sign = radial::SignTest::certain;
  PairFilter filter = PairFilter::certain_sign;
};

// Dynamic radial view based culling, the paper's method. Needs a closed, consistently oriented mesh and a
// rig.
Prepared make_drvbc(const Setup& setup, const DrvbcOptions& options = {});

}  // namespace cscd
