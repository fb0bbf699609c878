#include "core/hierarchy/bounds.h"

namespace cscd {

template <class Volume>
SweptVolumes<Volume>::SweptVolumes(const TriangleMesh& mesh, const Tree& tree)
    : vertex_(mesh.vertex_count()), node_(tree.node_count()) {}

template <class Volume>
void SweptVolumes<Volume>::refit(const TriangleMesh& mesh, const Tree& tree, const Motion& motion) {
  swept_vertex_bounds(motion, std::span(vertex_));
  // Children follow their parents, so one backward pass meets them first.
  for (auto node = static_cast<NodeIndex>(tree.node_count()) - 1; node >= 0; --node) {
    Volume& bound = node_[static_cast<std::size_t>(node)];
    if (tree.is_leaf(node)) {
      bound = swept_triangle<Volume>(mesh.corners(tree.triangle(node)), vertex_);
    } else {
      bound = united((*this)[tree.left(node)], (*this)[tree.right(node)]);
    }
  }
}

template class SweptVolumes<Kdop16>;
template class SweptVolumes<Aabb>;

}  // namespace cscd
