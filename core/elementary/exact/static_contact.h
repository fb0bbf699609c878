#pragma once

#include <span>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Exact predicates on closed features at rest, for the coordinates exactly as they stand. A floating-point
// filter with a forward error bound answers most calls, and exact arithmetic answers the rest
// (static_contact.cpp). All features may be degenerate.

// The side of the plane a, b, c on which p lies, +1 or -1, if the filter is certain of it, else 0.
int certain_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

// True if the vertex lies on the triangle, its edges and corners included.
bool vertex_touches_triangle(const Vec3& vertex, const Vec3& a, const Vec3& b, const Vec3& c);

// True if the segments ab and cd share a point.
bool segments_touch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// True if the segment pq and the triangle abc share a point.
bool segment_touches_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

// Whether two different triangles of a mesh meet in these positions, [vertices], except in the vertices and
// edges they share. Exact.
bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b);

// Whether two triangles of a mesh pass through each other: each has corners strictly on both sides of the
// other's plane, and they share more than one point. Triangles that meet without passing through each other
// only touch. Exact.
bool triangles_cross(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b);

// How two triangles of a mesh lie on each other: 0 unless they lie in one plane and share more than points of
// their borders; then +1 if they face the same way, and -1 if they face each other. Exact.
int lie_on_each_other(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b);

}  // namespace cscd
