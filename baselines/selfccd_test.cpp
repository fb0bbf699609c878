#include "baselines/selfccd.h"

#include <gtest/gtest.h>
#include <map>

#include "core/mesh/adjacency.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

test::Shape open_ball() {
  test::Shape shape = test::icosphere(1);
  shape.triangles.resize(shape.triangles.size() - 7);
  return shape;
}

// Three triangles at one edge, a triangle that occurs twice, and two fans that meet in a vertex.
test::Shape odd_pieces() {
  using test::corners;
  return {std::vector<Vec3>(11, Vec3(0, 0, 0)),
          {corners(0, 1, 2), corners(1, 0, 3), corners(0, 1, 4), corners(1, 2, 5), corners(1, 2, 5),
           corners(5, 6, 7), corners(5, 8, 9), corners(8, 10, 9)}};
}

// The triangle pairs without a common vertex, together with the orphans, bring every feature pair exactly
// once. So as long as only bounds cull, no feature pair is lost (rule any-carrier).
TEST(RepresentativeTriangles, AndOrphansCoverEveryFeaturePairExactlyOnce) {
  for (const test::Shape& shape : {test::octahedron(), test::box(), test::icosphere(1), test::torus(7, 5),
                                   test::capped_tube(3, 3, 1, 3), test::ramp(5, 0.5, 1, 2, 1), open_ball(),
                                   odd_pieces(), test::together(test::box(), test::octahedron())}) {
    const TriangleMesh mesh = shape.mesh();
    const auto assignment = representative_triangles(mesh);
    std::map<FeaturePair, int> expected, brought;
    std::vector<TrianglePair> distant;
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
      for (std::size_t j = i + 1; j < mesh.triangle_count(); ++j) {
        const TrianglePair pair{TriangleId{static_cast<std::int32_t>(i)},
                                TriangleId{static_cast<std::int32_t>(j)}};
        const bool adjacent = share_vertex(mesh.corners(pair.a), mesh.corners(pair.b));
        for_each_carried(mesh, pair, [&](const FeaturePair& features) { expected[features] = 1; });
        // Pairs come in either order, as descents meet them.
        if (!adjacent) distant.push_back((i + j) % 2 == 0 ? pair : TrianglePair{pair.b, pair.a});
      }
    std::vector<CarriedPairs> by_triangles;
    assignment->append(distant, by_triangles);
    std::vector<FeaturePair> tested;
    for (const CarriedPairs& pairs : by_triangles)
      for_each_carried(mesh, pairs, [&](const FeaturePair& features) { tested.push_back(features); });
    const std::size_t by_pairs = tested.size();
    tested.insert(tested.end(), assignment->always().begin(), assignment->always().end());
    for (const FeaturePair& features : tested) ++brought[features];
    EXPECT_EQ(brought, expected) << mesh.triangle_count() << " triangles";
    if (mesh.triangle_count() > 50) {
      EXPECT_GT(by_pairs, 4 * assignment->always().size());
    }
  }
}

}  // namespace
}  // namespace cscd
