#include "core/fast/joints_of_parts.h"

#include <gtest/gtest.h>

#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

// A tube in three parts, the middle one the longest, and a tube of one part beside it. Mutations: the joint
// is the middle of the part; every part is a root.
TEST(JointsOfParts, HangsPartsOnTheLargestByTheirSeams) {
  test::Shape shape = test::uneven_tube(12, 60, 15, [](double) { return 0.8; });
  const std::size_t own = shape.triangles.size();
  const test::Shape other = test::uneven_tube(12, 10, 3, [](double) { return 0.8; });
  const auto first = static_cast<int>(shape.positions.size());
  shape.positions.insert(shape.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    shape.triangles.push_back(test::corners(first + static_cast<int>(t[0]), first + static_cast<int>(t[1]),
                                            first + static_cast<int>(t[2])));
  const TriangleMesh mesh = shape.mesh();
  std::vector<std::int32_t> part_of;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double x = 0;
    for (const VertexId v : mesh.triangles()[t]) x += shape.positions[+v].x() / 3;
    part_of.push_back(t >= own ? 3 : x < 4 ? 2 : x < 10 ? 0 : 1);
  }
  const Rig rig = joints_of_parts(mesh, shape.positions, part_of);
  EXPECT_EQ(rig.parent, (std::vector<BoneId>{BoneId{-1}, BoneId{0}, BoneId{0}, BoneId{-1}}));
  EXPECT_NEAR(rig.reference[2].head.x(), 4, 0.3);
  EXPECT_NEAR(rig.reference[1].head.x(), 10, 0.3);
  EXPECT_NEAR(rig.reference[0].tail.x(), 7, 0.5);
}

}  // namespace
}  // namespace cscd::fast
