#pragma once

#include "core/mesh/triangle_mesh.h"

namespace cscd {

inline bool contains(const Triangle& triangle, VertexId vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

inline bool share_vertex(const Triangle& a, const Triangle& b) {
  return contains(a, b[0]) || contains(a, b[1]) || contains(a, b[2]);
}

inline bool share_vertex(const Edge& a, const Edge& b) {
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

// Visits the triangles that share a vertex with a triangle, those beside one of its edges twice.
template <class Take>  // (triangle)
void for_each_neighbour(const TriangleMesh& mesh, TriangleId triangle, const Take& take) {
  for (const VertexId v : mesh.corners(triangle))
    for (const TriangleId other : mesh.triangles_at(v))
      if (other != triangle) take(other);
}

}  // namespace cscd
