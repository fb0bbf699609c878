#pragma once

#include "core/base/vec3.h"

namespace cscd {

// Exact static predicates on closed features, coordinates as they stand: a floating-point filter with a
// forward error bound first, exact arithmetic for the rest.

// Does the vertex lie on the triangle (its edges and corners included; the triangle may be degenerate)?
bool vertex_touches_triangle(const Vec3& vertex, const Vec3& a, const Vec3& b, const Vec3& c);

// Do the segments ab and cd share a point?
bool segments_touch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Do the segment pq and the triangle abc share a point?
bool segment_touches_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cscd
