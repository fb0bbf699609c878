#pragma once

#include <span>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/thickness.h"
#include "core/mesh/motion.h"

namespace cscd {

// Removes the feature pairs that certainly stay farther apart than their thickness (step.h), and keeps the
// others in order. Each pair is held against the directions between nearest points that its features may have
// half-way through the interval. Points move in straight lines, so where the gap along a fixed direction
// exceeds the thickness at both ends, it does so at every t.
void drop_farther_than(const Thickness& thickness, const TriangleMesh& mesh, const Motion& motion,
                       std::vector<FeaturePair>& pairs);

}  // namespace cscd
