#include "core/radial/visible_bones.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

using test::Shape;

VisibleBones find(const Shape& shape, const std::vector<Bone>& bones, int resolution = 40) {
  const TriangleMesh mesh = shape.mesh();
  return find_visible_bones(mesh, shape.positions, bones,
                            make_distance_field(mesh, shape.positions, resolution));
}

std::vector<BoneId> row(const VisibleBones& visible, std::size_t vertex) {
  return {visible.of(vertex).begin(), visible.of(vertex).end()};
}

TEST(VisibleBones, AnotherBranchIsHiddenHoweverNear) {
  // Vertices at the hole of the torus are nearer to the post in the hole than to the bones in the tube.
  const Shape shape = test::torus(40, 16, 2, 0.5);
  std::vector<Bone> bones{{{0.9, 0, -1}, {0.9, 0, 1}}};
  for (int i = 0; i < 20; ++i) {
    const auto joint = [](int k) {
      return Vec3(2 * std::cos(0.1 * std::numbers::pi * k), 2 * std::sin(0.1 * std::numbers::pi * k), 0);
    };
    bones.push_back({joint(i), joint(i + 1)});
  }
  const VisibleBones visible = find(shape, bones);
  const std::size_t innermost = 8;  // (1.5, 0, 0)
  ASSERT_LT((shape.positions[innermost] - Vec3(1.5, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(row(visible, innermost),
            (std::vector<BoneId>{BoneId{1}, BoneId{20}}));  // equally near, at their joint
  EXPECT_NEAR(visible.distance[innermost], 0.49, 0.02);
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    ASSERT_FALSE(visible.of(v).empty());
    EXPECT_NE(visible.of(v).front(), BoneId{0});
  }
}

TEST(VisibleBones, ComponentThatSeesNoneTakesTheNearest) {
  const Shape shape = test::together(test::octahedron(), test::moved(test::octahedron(), {5, 0, 0}));
  const VisibleBones visible = find(shape, {{{9, 9, 9}, {9, 9, 8}}, {{-0.2, 0, 0}, {0.2, 0, 0}}});
  for (std::size_t v = 0; v < 6; ++v) EXPECT_EQ(row(visible, v), std::vector<BoneId>{BoneId{1}});
  // The second octahedron holds no bone. Its vertices take the nearest bone, which lies in the first.
  for (std::size_t v = 6; v < 12; ++v) EXPECT_EQ(row(visible, v), std::vector<BoneId>{BoneId{1}});
  EXPECT_NEAR(visible.distance[6], 5.8, 1e-12);
}

TEST(VisibleBones, AllEquallyNearBonesAreKeptInOrder) {
  const Shape shape = test::octahedron();
  const Bone bone{{0, 0, -0.1}, {0, 0, 0.1}};
  const VisibleBones visible = find(shape, {bone, {{0, 0, 0}, {0, 0, 0}}, bone});
  EXPECT_EQ(row(visible, 4), (std::vector<BoneId>{BoneId{0}, BoneId{2}}));             // (0, 0, 1)
  EXPECT_EQ(row(visible, 0), (std::vector<BoneId>{BoneId{0}, BoneId{1}, BoneId{2}}));  // (1, 0, 0)
}

TEST(VisibleBones, UnusedVertexHasNone) {
  Shape shape = test::octahedron();
  shape.positions.emplace_back(0, 0, 0);
  const VisibleBones visible = find(shape, {{{0, 0, 0}, {0, 0, 0.1}}});
  EXPECT_TRUE(visible.of(6).empty());
  EXPECT_EQ(visible.of(5).size(), 1u);
}

TEST(DistanceToBone, IsFiniteWhateverTheBone) {
  EXPECT_DOUBLE_EQ(distance_to({{0, 0, 0}, {2, 0, 0}}, {1, 3, 0}), 3);
  EXPECT_DOUBLE_EQ(distance_to({{0, 0, 0}, {2, 0, 0}}, {5, 4, 0}), 5);
  EXPECT_DOUBLE_EQ(distance_to({{1, 0, 0}, {1, 0, 0}}, {1, 0, 2}), 2);
  const double inf = std::numeric_limits<double>::infinity();
  for (const Bone& bone : {Bone{{inf, 0, 0}, {0, 0, 0}}, Bone{{inf, 0, 0}, {-inf, 0, 0}},
                           Bone{{1e308, 0, 0}, {-1e308, 0, 0}}, Bone{{1e200, 0, 0}, {1e200, 1e200, 0}}})
    EXPECT_TRUE(std::isfinite(distance_to(bone, {0, 1, 0})));
}

}  // namespace
}  // namespace cscd::radial
