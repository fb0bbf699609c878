#pragma once

#include <memory>

#include "core/detect/carried_pairs.h"
#include "core/detect/strategy.h"

namespace cscd {

// The traversal of SelfCCD (UNC Gamma group): representative triangles (Curtis, Tamstorf and Manocha, "Fast
// Collision Detection for Deformable Models using Representative-Triangles", I3D 2008) and orphan sets (Tang,
// Curtis, Yoon and Manocha, TVCG 15(4), 2009).
Prepared make_selfccd(const StrategyInput& setup);

// Assigns every feature pair to one triangle pair without a common vertex, or else to the orphans.
std::unique_ptr<const FeatureAssignment> representative_triangles(const TriangleMesh& mesh);

}  // namespace cscd
