#pragma once

#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The two kinds of elementary query: a moving vertex and a moving face, and two moving edges. Features are
// closed: a face contains its corners and edges, and an edge contains its ends.
struct MovingVertexFace {
  MovingPoint vertex, corner[3];
};
struct MovingEdgeEdge {
  MovingPoint first[2], second[2];
};

inline MovingVertexFace vertex_face(const TriangleMesh& mesh, const Motion& motion, VertexId vertex,
                                    TriangleId triangle) {
  const Triangle& c = mesh.corners(triangle);
  return {motion[vertex], {motion[c[0]], motion[c[1]], motion[c[2]]}};
}

inline MovingEdgeEdge edge_edge(const TriangleMesh& mesh, const Motion& motion, EdgeId first, EdgeId second) {
  const Edge &a = mesh.ends(first), &b = mesh.ends(second);
  return {{motion[a[0]], motion[a[1]]}, {motion[b[0]], motion[b[1]]}};
}

}  // namespace cscd
