#pragma once

#include <array>
#include <optional>

#include "core/detect/contact.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// How a feature pair touches, computed in doubles for people and for contact response. Whether and when it
// touches is decided elsewhere, exactly. The geometry does not depend on the unit of length: where all
// coordinates are multiplied by a power of two, lengths are multiplied by the same power, and directions and
// weights stay the same to the last digit, as long as nothing overflows or becomes subnormal.
//
// A contact has two sides. The first is the vertex, or the edge `a` of the pair; the second is the face, or
// the edge `b`.
struct ContactGeometry {
  Vec3 point;  // on the first feature at the time of contact
  // Where the contact lies on the features. For a vertex and a face: the barycentric weights of the face's
  // three corners, which sum to 1. For two edges: the share of the way along the first edge and along the
  // second, each from the end with the smaller index, in [0, 1].
  std::array<double, 3> weights{};
  int weight_count = 0;  // 3 or 2
  // The unit vector from the second feature to the first, towards the side from which the first came. Absent
  // where the features leave no direction, because the face has no area or the edges are parallel or points,
  // and where they moreover did not come from different places.
  std::optional<Vec3> normal;
  // How fast the first feature moves away from the second along the normal, in lengths per interval; negative
  // where they approach. Absent without a normal.
  std::optional<double> relative_speed;
};

// Returns the vertices of a feature pair: the vertex and the corners of the face, or the ends of edge `a` and
// then those of edge `b`.
std::array<VertexId, 4> vertices_of(const TriangleMesh& mesh, const FeaturePair& pair);

// Returns the geometry of one contact of a moving mesh. `time` is the time of the contact, in [0, 1]. With
// `at_distance` the features are close instead of touching: `point` and `weights` are those of nearest
// points, and the normal leads from the one on the second feature to the one on the first.
ContactGeometry contact_geometry(const TriangleMesh& mesh, const Motion& motion, const FeaturePair& pair,
                                 double time, bool at_distance = false);

}  // namespace cscd
