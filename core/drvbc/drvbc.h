#pragma once

#include <string_view>

#include "core/detect/compose.h"
#include "core/detect/strategy.h"
#include "core/radial/bone_clusters.h"
#include "core/radial/divided_clusters.h"
#include "core/radial/orientation.h"

namespace cscd {

// The parameters of the paper, with the paper's values.
struct DrvbcOptions {
  double gamma = 0.05;  // gamma: clusters merge while less than this share of a candidate's triangles is not
                        // positive; 0: never
  radial::BoneClusterOptions bones{};
  radial::Division division = radial::Division::joints;  // see the readings in divided_clusters.h
  bool relative_boxes = true;
  // Rows of the ablation leave one thing out each.
  std::string_view name = "drvbc";  // begins error texts
  bool cache = true;                // keep a cache of triangles that were not positive (section 5)
  radial::SegmentTest segment_test = radial::SegmentTest::all_corners;
};

// Prepares the strategy `drvbc`: Dynamic Radial View Based Culling (Wong, Lin, Wang, Hung, Huang, I3D 2014).
// Throws InputError if the mesh is not closed and consistently oriented, or if the set-up has no bones.
Prepared make_drvbc(const StrategyInput& setup, const DrvbcOptions& options = {});

}  // namespace cscd
