#include "core/hierarchy/bounds.h"

namespace cscd {

SweptBounds::SweptBounds(const TriangleMesh& mesh, const Tree& tree)
    : vertex_(mesh.vertex_count()), node_(tree.node_count()) {}

void SweptBounds::refit(const TriangleMesh& mesh, const Tree& tree, const Motion& motion) {
  swept_vertex_bounds(motion, vertex_);
  // Children follow their parents, so one backward pass meets them first.
  for (auto node = static_cast<NodeIndex>(tree.node_count()) - 1; node >= 0; --node) {
    Kdop16& bound = node_[static_cast<std::size_t>(node)];
    if (tree.is_leaf(node)) {
      const Triangle& corner = mesh.corners(tree.triangle(node));
      bound = united(united(vertex_[+corner[0]], vertex_[+corner[1]]), vertex_[+corner[2]]);
    } else {
      bound = united((*this)[tree.left(node)], (*this)[tree.right(node)]);
    }
  }
}

}  // namespace cscd
