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

}  // namespace cscd
