#pragma once

#include <vector>

#include "core/detect/contact.h"
#include "core/detect/detector.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Returns the triangle pairs that carry a feature pair: one triangle has the first feature, and
// the other has the second feature.
std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair);

}  // namespace cscd
