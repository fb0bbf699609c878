#pragma once

#include <span>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/detector.h"
#include "core/detect/step.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Returns the triangle pairs that carry a feature pair: one triangle has the first feature, and
// the other has the second feature.
std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair);

// Pairs of triangles that meet in a pose, in two kinds; both sorted.
struct Meetings {
  // They pass through each other (triangles_cross). Or they lie in one plane and face the same way, as walls
  // of two boxes that are flush: of closed surfaces, what lies behind both is then inside both. Or they
  // belong to two components of which one is a copy: every triangle of that one lies exactly on a triangle of
  // the other, as a coat that was copied from a body.
  Crossings crossing;
  Crossings touching;  // they only touch: nothing lies in anything
};
// Tells the pairs that meet in a pose, all of which must be kept, apart by their kind.
Meetings tell_meetings_apart(const TriangleMesh& mesh, std::span<const Vec3> positions, const Crossings& met);

}  // namespace cscd
