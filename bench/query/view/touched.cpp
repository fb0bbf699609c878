#include "bench/query/view/touched.h"

#include <span>

namespace cscd::bench {

void mark_touched(const TriangleMesh& mesh, const FeaturePair& pair, std::vector<bool>& touched) {
  const auto mark = [&](std::span<const TriangleId> triangles) {
    for (const TriangleId t : triangles) touched[+t] = true;
  };
  if (pair.kind == FeaturePair::Kind::vertex_face) {
    mark(mesh.triangles_at(VertexId{pair.a}));
    touched[+TriangleId{pair.b}] = true;
  } else {
    mark(mesh.triangles_at(EdgeId{pair.a}));
    mark(mesh.triangles_at(EdgeId{pair.b}));
  }
}

}  // namespace cscd::bench
