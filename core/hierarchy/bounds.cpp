#include "core/hierarchy/bounds.h"

namespace cscd {

namespace {

// Number of nodes whose bounds are computed in one pass: few enough to be still in the
// cache when their parents need them.
constexpr NodeIndex kNodesAtOnce = 1024;

}  // namespace

template <class Volume>
SweptVolumes<Volume>::SweptVolumes(const TriangleMesh& mesh, const Tree& tree, Pipeline pipeline)
    : vertex_(mesh.vertex_count()), node_(tree.node_count()), pipeline_(pipeline) {
  for (auto node = static_cast<NodeIndex>(tree.node_count()) - 1; node >= 0; --node)
    if (tree.is_leaf(node))
      leaves_.push_back({node, mesh.corners(tree.triangle(node))});
    else
      inner_.push_back({node, tree.right(node)});
}

template <class Volume>
void SweptVolumes<Volume>::refit(const Motion& motion, double margin) {
  if (pipeline_ == Pipeline::published) return refit_one_by_one(motion, margin);
  swept_vertex_bounds(motion, std::span(vertex_));
  if (margin > 0)
    for (Volume& volume : vertex_) volume = thickened(volume, margin);
  Volume* const node = node_.data();
  auto leaf = leaves_.begin();
  auto inner = inner_.begin();
  for (auto end = static_cast<NodeIndex>(node_.size()); end > 0; end -= kNodesAtOnce) {
    const NodeIndex begin = end - kNodesAtOnce;
    for (; leaf != leaves_.end() && leaf->node >= begin; ++leaf)
      node[leaf->node] = swept_triangle<Volume>(leaf->corners, vertex_);
    for (; inner != inner_.end() && inner->node >= begin; ++inner)
      node[inner->node] = united(node[inner->node + 1], node[inner->right]);
  }
}

template class SweptVolumes<Kdop16>;
template class SweptVolumes<Aabb>;

}  // namespace cscd
