#pragma once

#include "core/base/vec3.h"
#include "core/geometry/feature_motion.h"

namespace cscd {

// Squared smallest distances between closed features, to within rounding. Features may be degenerate. These
// are measures in plain floating point and prove nothing.
double squared_point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);
double squared_segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);
double squared_point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// Smallest distances of two moving features at time t.
double distance_at(const MovingVertexFace& query, double t);
double distance_at(const MovingEdgeEdge& query, double t);

}  // namespace cscd
