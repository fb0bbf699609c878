#include "core/hierarchy/bounds.h"

// The refit of the pipeline `published`: one vertex, one triangle and one node at a time. This file is
// compiled without automatic vectorisation (CMakeLists.txt). The loop takes in everything that it calls, so
// that no copy of an inline function that was compiled elsewhere, with vector code, is called in its place.
namespace cscd {
namespace {

Kdop16 path_bounds(const MovingPoint& p, const Kdop16&) {
  return kdop_of(p);
}
Aabb path_bounds(const MovingPoint& p, const Aabb&) {
  return aabb_of(p);
}

}  // namespace

template <class Volume>
[[gnu::flatten]] void SweptVolumes<Volume>::refit_one_by_one(const Motion& motion, double margin) {
  for (std::size_t v = 0; v < vertex_.size(); ++v)
    vertex_[v] = path_bounds(motion[VertexId{static_cast<std::int32_t>(v)}], vertex_[v]);
  if (margin > 0)
    for (Volume& volume : vertex_) volume = thickened(volume, margin);
  Volume* const node = node_.data();
  auto inner = inner_.begin();
  auto leaf = leaves_.begin();
  for (auto n = static_cast<NodeIndex>(node_.size()) - 1; n >= 0; --n)
    if (leaf != leaves_.end() && leaf->node == n) {
      node[n] = swept_triangle<Volume>(leaf->corners, vertex_);
      ++leaf;
    } else {
      node[n] = united(node[n + 1], node[inner->right]);
      ++inner;
    }
}

template void SweptVolumes<Kdop16>::refit_one_by_one(const Motion&, double);
template void SweptVolumes<Aabb>::refit_one_by_one(const Motion&, double);

}  // namespace cscd
