#include "core/detect/start/crossings.h"

#include <algorithm>

namespace cscd {
namespace {

std::span<const TriangleId> triangles_with_first(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == FeaturePair::Kind::vertex_face) return mesh.triangles_at(VertexId{pair.a});
  return mesh.triangles_at(EdgeId{pair.a});
}

}  // namespace

std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair) {
  const TriangleId face{pair.b};
  const std::span<const TriangleId> others =
      pair.kind == FeaturePair::Kind::vertex_face ? std::span(&face, 1) : mesh.triangles_at(EdgeId{pair.b});
  std::vector<CrossingPair> out;
  for (const TriangleId s : triangles_with_first(mesh, pair))
    for (const TriangleId t : others)
      if (s != t) out.emplace_back(std::min(s, t), std::max(s, t));
  return out;
}

}  // namespace cscd
