#pragma once

#include "core/geometry/bernstein.h"
#include "core/geometry/feature_motion.h"

// The deforming non-penetration filter (Tang, Manocha and Tong, I3D 2010; section 7.1 of the paper).
//
// Features can only touch while their four points are coplanar. If the four Bernstein coefficients of the
// coplanarity cubic share a sign, they never are. Difference to the published filter: the sign has to exceed
// a forward error bound, so "apart" is a proof. About 120 floating-point operations.
namespace cscd {

inline MovingVector difference(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
}

// Six times the signed volume of the tetrahedron.
inline BernsteinCubic coplanarity(const MovingVertexFace& q) {
  return triple_product(difference(q.corner[0], q.corner[1]), difference(q.corner[0], q.corner[2]),
                        difference(q.corner[0], q.vertex));
}
inline BernsteinCubic coplanarity(const MovingEdgeEdge& q) {
  return triple_product(difference(q.first[0], q.first[1]), difference(q.second[0], q.second[1]),
                        difference(q.first[0], q.second[0]));
}

// True proves that the features never touch.
template <class Query>
bool never_coplanar(const Query& query) {
  return certain_sign(coplanarity(query)) != 0;
}

}  // namespace cscd
