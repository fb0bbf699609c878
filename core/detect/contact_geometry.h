#pragma once

#include <array>
#include <optional>

#include "core/detect/contact.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// How a feature pair touches, computed in doubles, for people and for contact response. Whether and when the
// pair touches is decided elsewhere, exactly.
//
// A contact has two sides. The first feature is the vertex, or the edge FeaturePair::a. The second feature is
// the face, or the edge FeaturePair::b.
struct ContactGeometry {
  Vec3 point;  // on the first feature at the time of contact, in lengths of the scene
  // The place of the contact on the features. For a vertex and a face: the barycentric weights of the face's
  // three corners, which sum to 1. For two edges: the share of the way along the first edge and along the
  // second, each in [0, 1] and measured from the end with the smaller index.
  std::array<double, 3> weights{};
  int weight_count = 0;  // 3 or 2
  // Unit vector from the second feature to the first, that is, towards the side from which the first feature
  // came. It is absent if nothing defines a direction: the features define none (a face without area, edges
  // that are parallel or have length zero), and they started from the same place too.
  std::optional<Vec3> normal;
  // The speed at which the first feature moves away from the second along the normal, in lengths of the scene
  // per interval; it is negative if they approach. Absent if there is no normal.
  std::optional<double> relative_speed;
};

// Returns the geometry of one contact of a moving mesh. `time` is the time of the contact, in [0, 1].
ContactGeometry contact_geometry(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair,
                                 double time);

}  // namespace cscd
