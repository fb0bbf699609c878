#include "core/fast/prepare/cluster_observer.h"

#include <gtest/gtest.h>

#include "core/fast/clusters/best_viewpoint.h"
#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

std::vector<TriangleId> all_of(const TriangleMesh& mesh) {
  std::vector<TriangleId> all;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    all.push_back(TriangleId{static_cast<std::int32_t>(t)});
  return all;
}

double seen_from(const Vec3& from, const TriangleMesh& mesh, std::span<const Vec3> positions) {
  std::size_t seen = 0;
  for (const TriangleId t : all_of(mesh)) {
    const Face face = face_of(mesh, positions, t);
    seen += face.normal.dot(face.centre - from) > 0;
  }
  return static_cast<double>(seen) / static_cast<double>(mesh.triangle_count());
}

// From a plane nothing of it can be seen. Mutation: observers stay among the vertices.
TEST(Observer, StandsOffASheet) {
  for (const double wave : {0.0, 0.02, 0.2}) {
    test::Shape shape = test::sheet(25);
    for (Vec3& p : shape.positions) p.z() = wave * std::sin(3 * p.x()) * std::cos(2 * p.y());
    const TriangleMesh mesh = shape.mesh();
    const FollowingPoint observer = observer_of(mesh, shape.positions, all_of(mesh));
    EXPECT_TRUE(observer.stands_off() || wave > 0);  // vertices of waves carry a point below them
    const Vec3 from = observer.at(shape.positions);
    EXPECT_LT(from.z(), -0.1);
    EXPECT_GT(seen_from(from, mesh, shape.positions), 0.9) << wave;
  }
}

TEST(Observer, StaysInsideABall) {
  const test::Shape shape = test::icosphere(3);
  const TriangleMesh mesh = shape.mesh();
  EXPECT_FALSE(observer_of(mesh, shape.positions, all_of(mesh)).stands_off());
}

// The frame in which it stands off is carried by the vertices: it turns, moves and grows with them.
// Mutations: the offset is that of the reference pose; its length does not follow the area.
TEST(Observer, IsCarriedAlong) {
  test::Shape shape = test::sheet(25);
  const TriangleMesh mesh = shape.mesh();
  const FollowingPoint observer = observer_of(mesh, shape.positions, all_of(mesh));
  const Vec3 before = observer.at(shape.positions);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto moved = [&](const Vec3& p) -> Vec3 { return 5 * turn * p + Vec3(7, 8, 9); };
  for (Vec3& p : shape.positions) p = moved(p);
  EXPECT_LT((observer.at(shape.positions) - moved(before)).norm(), 1e-5);
}

TEST(Observer, IsAPointOfTheSurfaceWhereThatHasNoArea) {
  test::Shape shape = test::sheet(4);
  const TriangleMesh mesh = shape.mesh();
  const FollowingPoint observer = observer_of(mesh, shape.positions, all_of(mesh));
  for (Vec3& p : shape.positions) p = Vec3(p.x(), 0, 0);
  EXPECT_EQ(observer.at(shape.positions).z(), 0);
  for (Vec3& p : shape.positions) p = Vec3::Zero();
  EXPECT_TRUE(observer_of(mesh, shape.positions, all_of(mesh)).at(shape.positions).allFinite());
}

}  // namespace
}  // namespace cscd::fast
