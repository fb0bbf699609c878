#include "core/geometry/feature_motion.h"

#include <gtest/gtest.h>

#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

void expect_same(const MovingPoint& found, const Motion& motion, VertexId vertex) {
  EXPECT_EQ(found.start, motion.start()[+vertex]);
  EXPECT_EQ(found.end, motion.end()[+vertex]);
}

// A query is made of the moving vertices of the mesh. Mutation: a vertex is taken for another.
TEST(FeatureMotion, AQueryHoldsTheVerticesOfItsFeatures) {
  const test::Shape shape = test::octahedron();
  const TriangleMesh mesh = shape.mesh();
  std::vector<Vec3> end = shape.positions;
  for (Vec3& p : end) p += Vec3(7, 8, 9);
  const Motion motion(shape.positions, end);
  for (std::int32_t t = 0; t < 8; ++t)
    for (std::int32_t v = 0; v < 6; ++v) {
      const MovingVertexFace query = vertex_face(mesh, motion, VertexId{v}, TriangleId{t});
      expect_same(query.vertex, motion, VertexId{v});
      for (std::size_t k = 0; k < 3; ++k)
        expect_same(query.corner[k], motion, mesh.corners(TriangleId{t})[k]);
    }
  for (std::int32_t e = 0; e < 12; ++e)
    for (std::int32_t f = 0; f < 12; ++f) {
      const MovingEdgeEdge query = edge_edge(mesh, motion, EdgeId{e}, EdgeId{f});
      for (std::size_t k = 0; k < 2; ++k) {
        expect_same(query.first[k], motion, mesh.ends(EdgeId{e})[k]);
        expect_same(query.second[k], motion, mesh.ends(EdgeId{f})[k]);
      }
    }
}

}  // namespace
}  // namespace cscd
