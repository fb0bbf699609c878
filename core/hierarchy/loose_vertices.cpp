#include "core/hierarchy/loose_vertices.h"

namespace cscd {
namespace {

template <class Visit>
void for_each_loose(const TriangleMesh& mesh, const Visit& visit) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (const VertexId id{static_cast<std::int32_t>(v)}; mesh.triangles_at(id).empty()) visit(id);
}

}  // namespace

LooseVertices::LooseVertices(const TriangleMesh& mesh, std::span<const Vec3> reference,
                             std::size_t own_vertices)
    : mesh_(&mesh), own_vertices_(own_vertices) {
  for_each_loose(mesh, [&](VertexId v) { loose_.push_back(v); });
  if (empty()) return;
  tree_ = build_tree(mesh, reference);
  boxes_.emplace(mesh, tree_);
}

LooseCount count_loose_vertices(const TriangleMesh& mesh) {
  LooseCount found;
  for_each_loose(mesh, [&](VertexId v) {
    if (found.count++ == 0) found.first = v;
  });
  return found;
}

}  // namespace cscd
