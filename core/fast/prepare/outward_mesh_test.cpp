#include "core/fast/prepare/outward_mesh.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <utility>

#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

// Appends a ball of radius 1 about `middle`, cut off below the height `least` over its middle.
void add_ball(test::Shape& to, const Vec3& middle, bool inward, double least = -2) {
  const test::Shape ball = test::split_onto_sphere(test::split_onto_sphere(test::octahedron(), 1), 1);
  const auto first = static_cast<std::int32_t>(to.positions.size());
  for (const Vec3& p : ball.positions) to.positions.push_back(middle + p);
  for (Triangle t : ball.triangles) {
    if (std::ranges::any_of(t, [&](VertexId v) { return ball.positions[+v].z() < least; })) continue;
    if (inward) std::swap(t[1], t[2]);
    for (VertexId& v : t) v = VertexId{first + static_cast<std::int32_t>(+v)};
    to.triangles.push_back(t);
  }
}

// Closed balls and half balls, far from the origin. Mutations: turn what faces outward; measure from the
// origin; turn one triangle alone.
TEST(OutwardMesh, TurnsTheComponentsThatFaceInward) {
  test::Shape mixed, outward;
  const auto add = [&](double x, bool inward, double least) {
    add_ball(mixed, {x, 50, 0}, inward, least);
    add_ball(outward, {x, 50, 0}, false, least);
  };
  add(0, false, -2), add(3, true, -2), add(6, true, 0), add(9, false, 0);
  const auto turned = turned_outward(mixed.mesh(), mixed.positions);
  ASSERT_NE(turned, nullptr);
  EXPECT_TRUE(std::ranges::equal(turned->triangles(), outward.triangles));
  EXPECT_EQ(turned_outward(outward.mesh(), outward.positions), nullptr);
}

// Neither side of a flat cap is the outside. Mutation: open components as closed ones.
TEST(OutwardMesh, LeavesClothAsItIs) {
  test::Shape caps;
  add_ball(caps, {0, 0, 0}, true, 0.9);
  ASSERT_FALSE(caps.triangles.empty());
  for (Vec3& p : caps.positions) p.z() *= 0.1;
  EXPECT_EQ(turned_outward(caps.mesh(), caps.positions), nullptr);
}

}  // namespace
}  // namespace cscd::fast
