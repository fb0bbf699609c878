#include "core/detect/feature_owners.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "core/mesh/adjacency.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

std::vector<FeaturePair> all_that_may_touch(const TriangleMesh& mesh) {
  std::vector<FeaturePair> pairs;
  const auto ids = [](std::size_t count) { return static_cast<std::int32_t>(count); };
  for (std::int32_t v = 0; v < ids(mesh.vertex_count()); ++v)
    for (std::int32_t t = 0; t < ids(mesh.triangle_count()); ++t)
      if (!mesh.triangles_at(VertexId{v}).empty() && !contains(mesh.corners(TriangleId{t}), VertexId{v}))
        pairs.push_back(FeaturePair::of(VertexId{v}, TriangleId{t}));
  for (std::int32_t e = 0; e < ids(mesh.edge_count()); ++e)
    for (std::int32_t f = e + 1; f < ids(mesh.edge_count()); ++f)
      if (!share_vertex(mesh.ends(EdgeId{e}), mesh.ends(EdgeId{f})))
        pairs.push_back(FeaturePair::of(EdgeId{e}, EdgeId{f}));
  std::ranges::sort(pairs);
  return pairs;
}

// A closed surface, an open one with a vertex that no triangle has, and triangles that occur twice.
// Mutations: the edges of the second triangle stand in the place of the first one's; a feature that is left
// is given to nobody; a feature is given twice.
TEST(FeatureOwners, OwnEveryFeaturePairOnce) {
  test::Shape open = test::icosphere(1);
  open.triangles.resize(open.triangles.size() / 2);
  test::Shape twice = test::octahedron();
  twice.triangles.push_back(twice.triangles[3]);
  for (const test::Shape& shape : {test::icosphere(2), open, twice}) {
    const TriangleMesh mesh = shape.mesh();
    const FeatureOwners owners(mesh);
    std::vector<FeaturePair> owned;
    std::size_t nothing = 0, pairs = 0;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.triangle_count()); ++i)
      for (std::int32_t j = i + 1; j < static_cast<std::int32_t>(mesh.triangle_count()); ++j) {
        const TrianglePair pair{TriangleId{i}, TriangleId{j}};
        const CarriedPlaces places =
            carried_by(mesh.corners(pair.a), mesh.corners(pair.b)) & owners.owned_by(pair);
        for_each_carried(mesh, CarriedPairs{pair, places},
                         [&](const FeaturePair& features) { owned.push_back(features); });
        nothing += places == 0;
        ++pairs;
      }
    std::ranges::sort(owned);
    EXPECT_EQ(owned, all_that_may_touch(mesh));
    EXPECT_GT(4 * nothing, pairs);
  }
}

}  // namespace
}  // namespace cscd
