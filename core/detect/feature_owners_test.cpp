#include "core/detect/feature_owners.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "core/detect/test_feature_pairs.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

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
    std::vector<FeaturePair> all = test::all_feature_pairs(mesh);
    std::erase_if(all, [&](const FeaturePair& features) {  // no triangle owns a loose vertex
      return features.kind == FeaturePair::Kind::vertex_face &&
             mesh.triangles_at(VertexId{features.a}).empty();
    });
    EXPECT_EQ(owned, all);
    EXPECT_GT(4 * nothing, pairs);
  }
}

}  // namespace
}  // namespace cscd
