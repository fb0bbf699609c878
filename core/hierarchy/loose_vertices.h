#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"

namespace cscd {

// Finds the triangles that the *loose* vertices of a mesh may come near. A loose vertex is of no triangle, so
// no pair of triangles carries its feature pairs, and no descent over pairs of triangles finds them. It is a
// point that collides with triangles, such as a particle.
class LooseVertices {
 public:
  // `reference`, [vertices], is any pose of the mesh. With `own_vertices`, a vertex and a triangle are held
  // against each other only if one of them is among the first so many vertices and the other is not. The mesh
  // must outlive the object, which costs nothing where no vertex is loose.
  LooseVertices(const TriangleMesh& mesh, std::span<const Vec3> reference, std::size_t own_vertices = 0);

  bool empty() const { return loose_.empty(); }
  // Calls visit(vertex, triangle) for every loose vertex and triangle that may come within `distance` of each
  // other, in the order of the vertices.
  template <class Visit>
  void for_each_near(const Motion& motion, double distance, const Visit& visit) {
    if (empty()) return;
    boxes_->refit(motion);
    for (const VertexId v : loose_) {
      const Aabb box = aabb_of(motion[v]);
      descend(distance > 0 ? thickened(box, distance) : box, v, 0, visit);
    }
  }

 private:
  template <class Visit>
  void descend(const Aabb& box, VertexId v, NodeIndex node, const Visit& visit) const {
    if (!overlap(box, (*boxes_)[node])) return;
    if (!tree_.is_leaf(node)) {
      descend(box, v, tree_.left(node), visit);
      descend(box, v, tree_.right(node), visit);
    } else if (own_vertices_ == 0 || is_own(v) != is_own(mesh_->corners(tree_.triangle(node))[0])) {
      visit(v, tree_.triangle(node));
    }
  }
  bool is_own(VertexId v) const { return +v < own_vertices_; }

  const TriangleMesh* mesh_;
  std::size_t own_vertices_;
  std::vector<VertexId> loose_;  // ascending
  Tree tree_;
  std::optional<SweptBoxes> boxes_;
};

// The number of loose vertices of a mesh, and the first of them.
struct LooseCount {
  std::size_t count = 0;
  VertexId first{-1};
};
LooseCount count_loose_vertices(const TriangleMesh& mesh);

}  // namespace cscd
