#include "bench/answer/joints.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "bench/inputs/test_inputs.h"

namespace cscd::bench {
namespace {

// Of a surface without bones, parts meet at a joint where they share a vertex. Mutations: a part folds onto
// itself; parts apart from each other are neighbours.
TEST(Joints, JoinPartsThatShareAVertex) {
  const test::Shape ball = test::icosphere(1);
  const test::Shape balls = test::together(ball, test::moved(ball, {3, 0, 0}));
  Input input = input_of(balls, {balls.positions, balls.positions});
  input.import.emplace();
  for (const char* name : {"shin", "foot", "stone"}) input.import->parts.push_back({name, name});
  input.sources.emplace();
  const std::size_t n = ball.triangles.size();
  for (std::size_t t = 0; t < 2 * n; ++t)
    input.sources->triangle.push_back({.part = t < n / 2 ? 0 : t < n ? 1 : 2});
  const Joints joints(input, SurfaceNames(input));
  EXPECT_TRUE(joints.join({"shin", "foot"}));
  EXPECT_TRUE(joints.join({"foot", "shin"}));
  EXPECT_FALSE(joints.join({"shin", "shin"}));
  EXPECT_FALSE(joints.join({"shin", "stone"}));
}

// Mutation: all that one node moves is one bone, whose pieces fold onto themselves.
TEST(Joints, OneNodeHasNone) {
  const test::Shape ball = test::icosphere(1);
  Input input = input_of(ball, {ball.positions, ball.positions});
  scenes::ClipHeader header = input.clip->header();
  header.bone_parent = {BoneId{-1}};
  auto clip = std::make_unique<scenes::Clip>(header);
  const Bone still;
  for (int frame = 0; frame < 2; ++frame) clip->append({ball.positions, std::span(&still, 1)});
  input.clip = std::move(clip);
  input.bone_names = {"crate"};
  input.rig = scenes::rig_of(*input.clip);
  input.sources.emplace();
  input.sources->triangle.resize(ball.triangles.size());
  input.sources->bone.assign(ball.positions.size(), 0);
  EXPECT_FALSE(Joints(input, SurfaceNames(input)).join({"crate", "crate"}));
}

// Mutations: the girth is that of the thicker piece; what is not known to be shallow is a fold.
TEST(Joints, FoldLessThanATenthOfTheGirth) {
  // A long tube of radius 1 and one of radius 2, end to end.
  test::Shape tube;
  constexpr int kAround = 48;
  const auto ring = [&](double z, double radius) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      tube.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  };
  const auto join_rings = [&](int lower) {
    for (int i = 0; i < kAround; ++i) {
      const int a = lower * kAround + i, b = lower * kAround + (i + 1) % kAround;
      for (const auto& [p, q, r] : {std::array{a, b, b + kAround}, {a, b + kAround, a + kAround}})
        tube.triangles.push_back({VertexId{p}, VertexId{q}, VertexId{r}});
    }
  };
  for (const double z : {0.0, 10.0}) ring(z, 1);
  for (const double z : {10.0, 30.0}) ring(z, 2);
  for (const int lower : {0, 1, 2}) join_rings(lower);
  Input input = input_of(tube, {tube.positions, tube.positions});
  input.import.emplace();
  for (const char* name : {"thin", "thick"}) input.import->parts.push_back({name, name});
  input.sources.emplace();
  for (std::size_t t = 0; t < tube.triangles.size(); ++t)
    input.sources->triangle.push_back({.part = t < 2 * kAround ? 0 : 1});
  const Joints joints(input, SurfaceNames(input));
  const double tenth = Joints::kShare * 2 * std::numbers::pi;
  OverlapEvent event;
  event.names = {"thick", "thin"};
  for (const double share : {0.95, 1.05}) {
    event.depth.lower = share * tenth, event.depth.upper = 10 * tenth;
    EXPECT_EQ(joints.fold(event), share < 1) << share;
    event.depth.lower = 0, event.depth.upper = share * tenth;
    EXPECT_EQ(joints.fold(event), share < 1) << share;
  }
  event.names = {"thick", "thick"};
  event.depth = {};
  EXPECT_FALSE(joints.fold(event));
}

}  // namespace
}  // namespace cscd::bench
