#include <algorithm>

#include "core/detect/filter_block.h"
#include "core/elementary/question/filter.h"

// Compiled without automatic vectorisation (CMakeLists.txt), as the pipeline `published` asks for.
namespace cscd {

void drop_by_plain_sign(const TriangleMesh& mesh, const Motion& motion, std::vector<FeaturePair>& pairs) {
  std::erase_if(pairs, [&](const FeaturePair& pair) {
    BernsteinCubic f = pair.kind == FeaturePair::Kind::vertex_face
                           ? coplanarity(vertex_face(mesh, motion, VertexId{pair.a}, TriangleId{pair.b}))
                           : coplanarity(edge_edge(mesh, motion, EdgeId{pair.a}, EdgeId{pair.b}));
    f.error = 0;
    return certain_sign(f) != 0;
  });
}

}  // namespace cscd
