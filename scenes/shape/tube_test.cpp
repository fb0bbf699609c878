#include "scenes/shape/tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "scenes/catalog/shapes.h"
#include "scenes/shape/test_shapes.h"

namespace cscd::scenes {
namespace {

TubeParameters hairpin() {
  TubeParameters p;
  p.arc_turns = 0.5;
  p.arc_radius = 4;
  p.arc_side = -Vec3::UnitX();
  p.direction = -Vec3::UnitZ();
  p.start = Vec3(4, 0, 94);
  return p;
}

void expect_well_formed(const TubeParameters& p) {
  const Shape shape = tube(p);
  expect_well_formed(shape);
  EXPECT_EQ(shape.positions.size(), static_cast<std::size_t>(p.rings * p.sides + 2));
  EXPECT_EQ(shape.triangles.size(), 2 * static_cast<std::size_t>(p.rings * p.sides));
  EXPECT_EQ(shape.rig.parent.size(), static_cast<std::size_t>(p.bones));
  EXPECT_EQ(shape.bone_names.back(), "bone_" + std::to_string(p.bones - 1));
}

TEST(Tube, HasTheRopesCounts) {
  const Shape rope = tube({});
  EXPECT_EQ(rope.positions.size(), 24222u);
  EXPECT_EQ(rope.triangles.size(), 48440u);
  EXPECT_EQ(rope.rig.parent.size(), 100u);
}

TEST(Tube, IsClosedOrientedAndOfGenusZero) {
  expect_well_formed({});
  expect_well_formed(hairpin());
  TubeParameters least;
  least.rings = 2;
  least.sides = 3;
  least.bones = 1;
  least.length = 5;
  expect_well_formed(least);
}

TEST(Tube, MovesTheVerticesOfItsDetails) {
  TubeParameters p = hairpin();
  const Shape plain = tube(p);
  SurfaceDetail& raised = p.details.emplace_back();
  raised.at = Vec3(5, 0, 80);
  raised.reach = Vec3(0.5, 0.5, 2);
  raised.height = 0.1;
  const Shape detailed = tube(p);
  expect_well_formed(detailed);
  std::size_t moved = 0;
  for (std::size_t v = 0; v < plain.positions.size(); ++v) {
    const Vec3 by = detailed.positions[v] - plain.positions[v];
    moved += by.norm() > 0;
    EXPECT_TRUE(by.norm() == 0 || by.x() > 0) << "vertex " << v << " moves outwards or stays";
    EXPECT_LE(by.norm(), 0.1 + 1e-12);
  }
  EXPECT_GT(moved, 20u);
  EXPECT_EQ(detailed.weights.size(), plain.weights.size());
}

TEST(Tube, EnclosesACapsulesVolumeOutwards) {
  // By the theorem of Pappus the hairpin has the volume of the straight tube.
  const double expected = std::numbers::pi * 188 + 4 * std::numbers::pi / 3;
  EXPECT_NEAR(volume(tube({})), expected, 0.01 * expected);
  EXPECT_NEAR(volume(tube(hairpin())), expected, 0.01 * expected);
}

TEST(Tube, KeepsItsRadiusAroundItsBones) {
  for (const TubeParameters& p : {TubeParameters{}, hairpin()}) {
    const Shape shape = tube(p);
    for (std::size_t vertex = 0; vertex < shape.positions.size(); vertex += 7) {
      double nearest = 1e300;
      for (const Bone& bone : shape.rig.reference) {
        const Vec3 along = bone.tail - bone.head, to = shape.positions[vertex] - bone.head;
        const double t = std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (to - t * along).norm());
      }
      // The bones are chords of the arc and lie up to 0.12 inside the arc.
      EXPECT_NEAR(nearest, 1, p.arc_turns > 0 ? 0.13 : 1e-9) << "vertex " << vertex;
    }
  }
}

TEST(Tube, SharesAVertexBetweenAtMostThreeNeighbouringBones) {
  for (const JointWeights& weights : tube({}).weights) {
    EXPECT_EQ(weights.bone[3], BoneId{-1});
    const int first = static_cast<int>(weights.bone[0]);
    for (std::size_t k = 1; k < 3 && weights.bone[k] != BoneId{-1}; ++k)
      EXPECT_EQ(static_cast<int>(weights.bone[k]), first + static_cast<int>(k));
  }
}

TEST(Tube, RefusesWhatIsNoTube) {
  const auto refused = [](auto change) {
    TubeParameters p = hairpin();
    change(p);
    EXPECT_THROW(tube(p), InputError);
  };
  refused([](TubeParameters& p) { p.rings = 1; });
  refused([](TubeParameters& p) { p.sides = 2; });
  refused([](TubeParameters& p) { p.bones = 0; });
  refused([](TubeParameters& p) { p.length = 2; });
  refused([](TubeParameters& p) { p.direction = Vec3::Zero(); });
  refused([](TubeParameters& p) { p.arc_radius = 1; });
  refused([](TubeParameters& p) { p.arc_radius = 60; });
  refused([](TubeParameters& p) { p.rings = p.sides = 100000; });
}

TEST(Shapes, AreFoundByName) {
  const std::map<std::string, Parameters::Value, std::less<>> values = {
      {"rings", 10.0}, {"sides", 8.0}, {"bones", 4.0}, {"radius", 1.0}, {"length", 20.0}};
  EXPECT_EQ(make_shape("tube", Parameters("here", values)).positions.size(), 82u);
  EXPECT_EQ(test::refusal([&] { make_shape("teapot", Parameters("here", values)); }),
            "here: unknown shape teapot; known are: tube, box, limbed_sphere, skirted_limbed_sphere, "
            "sheet, ball");
}

}  // namespace
}  // namespace cscd::scenes
