#include "core/fast/clusters/limbs.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

Body body_of_shape(const test::Shape& shape) {
  const TriangleMesh mesh = shape.mesh();
  TrianglePaths paths(mesh, shape.positions);
  std::vector<double> area;
  std::vector<std::int32_t> piece(mesh.triangle_count(), 0);
  std::vector<TriangleId> all;
  for (const Triangle& c : mesh.triangles()) {
    const Vec3 a = shape.positions[+c[1]] - shape.positions[+c[0]],
               b = shape.positions[+c[2]] - shape.positions[+c[0]];
    area.push_back(a.cross(b).norm() / 2);
    all.push_back(TriangleId{static_cast<std::int32_t>(all.size())});
  }
  return body_of(paths, area, piece, all);
}

// The ends of the surface are moved outward by hand, so that it has as many limbs as directions.
test::Shape ball_with_limbs(const std::vector<Vec3>& directions) {
  test::Shape ball = test::icosphere(5);
  for (Vec3& p : ball.positions)
    for (const Vec3& direction : directions) {
      const double near = p.normalized().dot(direction);
      if (near > 0.9) p += direction * (60 * (near - 0.9));
    }
  return ball;
}

// Mutation: a limb grows over the whole hub.
TEST(Limbs, ATubeIsOneLimbAndABallWithLimbsHasAHub) {
  const Body tube = body_of_shape(test::capped_tube(16, 100, 1, 30));
  ASSERT_EQ(tube.limbs.size(), 1u);
  EXPECT_TRUE(tube.hub.empty());
  EXPECT_NEAR(tube.limbs[0].length(), 30, 3);

  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const test::Shape shape = ball_with_limbs({x, y, z, -y, -z});
  const Body body = body_of_shape(shape);
  EXPECT_EQ(body.limbs.size(), 5u);
  const TriangleMesh mesh = shape.mesh();
  EXPECT_GT(body.hub.size(), mesh.triangle_count() / 8);
  std::set<TriangleId> once(body.hub.begin(), body.hub.end());
  std::size_t triangles = body.hub.size();
  for (const Limb& limb : body.limbs) {
    once.insert(limb.triangles.begin(), limb.triangles.end());
    triangles += limb.triangles.size();
    EXPECT_EQ(limb.along.size(), limb.triangles.size());
    EXPECT_GT(limb.length(), 4);
    // The tip is the farthest from the middle of the ball.
    const auto tip = std::ranges::max_element(limb.along) - limb.along.begin();
    const TriangleId at_tip = limb.triangles[static_cast<std::size_t>(tip)];
    EXPECT_GT(shape.positions[+mesh.corners(at_tip)[0]].norm(), 5);
  }
  EXPECT_EQ(triangles, mesh.triangle_count()) << "each triangle is in one part";
  EXPECT_EQ(once.size(), mesh.triangle_count());
}

}  // namespace
}  // namespace cscd::fast
