#include "core/elementary/exact/triangles_meet.h"

#include "core/elementary/exact/static_contact.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

struct Frame {
  const TriangleMesh& mesh;
  std::span<const Vec3> x;

  bool touch(VertexId vertex, const Triangle& t) const {
    return vertex_touches_triangle(x[+vertex], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Triangle& t) const {
    return segment_touches_triangle(x[+e[0]], x[+e[1]], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Edge& f) const {
    return segments_touch(x[+e[0]], x[+e[1]], x[+f[0]], x[+f[1]]);
  }

  // Whether all vertices of `to` that `from` does not have certainly lie on one side of the plane of `from`.
  // Then `to` reaches that plane in the vertex or edge that both share alone, and the two meet nowhere else.
  // Neighbours are often nearly in one plane, and hardly ever exactly. So this settles most pairs, for the
  // price of one or two determinants.
  bool beside(TriangleId from, TriangleId to) const {
    const Triangle& plane = mesh.corners(from);
    int side = 0;
    for (const VertexId vertex : mesh.corners(to)) {
      if (contains(plane, vertex)) continue;
      const int here = certain_side(x[+plane[0]], x[+plane[1]], x[+plane[2]], x[+vertex]);
      if (here == 0 || here == -side) return false;
      side = here;
    }
    return side != 0;
  }

  // Returns whether a feature of the first triangle meets the second triangle outside the vertices
  // and edges that both share. An edge without a vertex of the second triangle is tested as a
  // whole, which covers its two ends.
  bool reaches(TriangleId from, TriangleId to) const {
    const Triangle& target = mesh.corners(to);
    for (const VertexId vertex : mesh.corners(from))
      if (!contains(target, vertex) && touch(vertex, target)) return true;
    for (const EdgeId id : mesh.edges_of(from)) {
      const Edge& edge = mesh.ends(id);
      const int shared = contains(target, edge[0]) + contains(target, edge[1]);
      if (shared == 0 && touch(edge, target)) return true;
      if (shared != 1) continue;
      // One end of the edge is shared. If the edge lies in the plane of the target, it can still cross
      // the side opposite to that end.
      for (const EdgeId side : mesh.edges_of(to)) {
        const Edge& other = mesh.ends(side);
        if (!share_vertex(edge, other) && touch(edge, other)) return true;
      }
    }
    return false;
  }
};

}  // namespace

bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b) {
  const Frame frame{mesh, positions};
  if (frame.beside(a, b) || frame.beside(b, a)) return false;
  return frame.reaches(a, b) || frame.reaches(b, a);
}

}  // namespace cscd
