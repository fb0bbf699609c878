#include "core/detect/carried_pairs.h"

#include <gtest/gtest.h>

#include "core/mesh/adjacency.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// The pairs of triangles include neighbours at an edge and at a corner, turned in every way, and
// triangles without a common vertex.
TEST(CarriedPairs, AreWhatTwoTrianglesHaveWithoutACommonVertex) {
  const TriangleMesh mesh = test::icosphere(1).mesh();
  std::size_t sizes[16] = {};
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.triangle_count()); ++i)
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(mesh.triangle_count()); ++j) {
      if (i == j) continue;
      const TriangleId a{i}, b{j};
      std::vector<FeaturePair> expected, met;
      for (const VertexId v : mesh.corners(a))
        if (!contains(mesh.corners(b), v)) expected.push_back(FeaturePair::of(v, b));
      for (const VertexId v : mesh.corners(b))
        if (!contains(mesh.corners(a), v)) expected.push_back(FeaturePair::of(v, a));
      for (const EdgeId e : mesh.edges_of(a))
        for (const EdgeId f : mesh.edges_of(b))
          if (!share_vertex(mesh.ends(e), mesh.ends(f))) expected.push_back(FeaturePair::of(e, f));
      for_each_carried(mesh, TrianglePair{a, b}, [&](const FeaturePair& pair) { met.push_back(pair); });
      ASSERT_EQ(met, expected) << i << " and " << j;
      ++sizes[met.size()];
    }
  EXPECT_GT(sizes[4], 0u);  // with a common edge
  EXPECT_GT(sizes[9], 0u);  // with a common corner
  EXPECT_GT(sizes[15], 0u);
}

TEST(CarriedPairs, ATriangleThatOccursTwiceCarriesNothing) {
  const test::Shape twice{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
                          {test::corners(0, 1, 2), test::corners(1, 2, 0)}};
  const TriangleMesh mesh = twice.mesh();
  EXPECT_EQ(carried_by(mesh.corners(TriangleId{0}), mesh.corners(TriangleId{1})), 0);
}

}  // namespace
}  // namespace cscd
