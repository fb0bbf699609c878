#pragma once

#include "core/geometry/bernstein.h"
#include "core/geometry/feature_motion.h"

// The deforming non-penetration filter (Tang, Manocha and Tong, I3D 2010; section 7.1 of the paper). Its
// "apart" is a proof (rule certain-sign, core/soundness.md); otherwise it says nothing.
//
// The first part uses that features can touch only while their four points are coplanar. If the four
// Bernstein coefficients of the coplanarity cubic share a sign, the points are never coplanar. This
// implementation differs from the published filter in one respect: each coefficient has to exceed a forward
// error bound. It takes about 120 floating-point operations.
//
// The second part finds features that come into one plane but stay apart in it (core/geometry/sideways.h).
// The published filter has no such part. It is made for surfaces that lie on one another, as where a rope
// rests on itself: there many pairs of features come into one plane. core/detect/filter_block.cpp asks both
// parts about eight pairs at a time.
namespace cscd {

// The vector from one moving point to another.
inline MovingVector difference(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
}

// Six times the signed volume of the tetrahedron of the four points, as a cubic in t.
inline BernsteinCubic coplanarity(const MovingVertexFace& q) {
  return triple_product(difference(q.corner[0], q.corner[1]), difference(q.corner[0], q.corner[2]),
                        difference(q.corner[0], q.vertex));
}
inline BernsteinCubic coplanarity(const MovingEdgeEdge& q) {
  return triple_product(difference(q.first[0], q.first[1]), difference(q.second[0], q.second[1]),
                        difference(q.first[0], q.second[0]));
}

// The first part of the filter. True proves that the features never touch.
template <class Query>
bool never_coplanar(const Query& query) {
  return certain_sign(coplanarity(query)) != 0;
}

}  // namespace cscd
