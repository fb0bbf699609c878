#include <gtest/gtest.h>

#include "scenes/cloth/ball.h"
#include "scenes/cloth/sheet.h"
#include "scenes/cloth/skirt.h"
#include "scenes/effects/test_effects.h"

namespace cscd::scenes {
namespace {

Shape small_sheet() {
  return sheet({8, 10, 1, Vec3(0, 0, 20), Vec3::UnitX(), Vec3::UnitY()});
}

Values laws(Values more = {}) {
  Values values = {{"gravity", std::vector<double>{0, 0, -0.05}},
                   {"drag", 0.02},
                   {"viscosity", 1.0},
                   {"bend_compliance", 0.1},
                   {"thickness", 0.9},
                   {"friction", 0.3}};
  values.merge(more);
  return values;
}

std::vector<Parameters> one(Values values) {
  return {Parameters("test, one object", std::move(values))};
}

Values grip(Table path, double from = 3.9) {
  return {{"from", std::vector<double>{from, -100, -100}},
          {"to", std::vector<double>{100, 100, 100}},
          {"path", std::move(path)}};
}

TEST(ClothDynamics, LeadsWhatIsGrippedAndLetsItGo) {
  const Shape shape = small_sheet();
  const std::vector<EffectCall> calls = {
      call("cloth_dynamics", laws({{"grips", one(grip({{2, 7, 0, 0}, {8, 9, 0, 1}}))}}))};
  EffectSequence sequence(calls, shape, 8);
  SceneState state(shape);
  std::vector<Vec3> gripped, before;
  for (int frame = 1; frame <= 9; ++frame) {
    before = state.positions;
    sequence.advance(state, frame);
    if (frame == 2) gripped = state.positions;
    for (std::size_t v = 0; v < shape.positions.size(); ++v) {
      if (shape.positions[v].x() < 3.9) continue;
      // A path is a way since its first key, from where the vertex is by then.
      if (frame == 8) expect_near(state.positions[v], gripped[v] + Vec3(2, 0, 1));
      if (frame == 1 || frame == 9) {
        EXPECT_LT(state.positions[v].z(), before[v].z()) << "free, so it falls";
      }
    }
  }
}

TEST(ClothDynamics, StaysOutOfABallThatMoves) {
  const Shape shape = small_sheet();
  const std::vector<EffectCall> calls = {
      call("cloth_dynamics",
           laws({{"balls", one({{"radius", 3.0}, {"path", Table{{0, 0, 0, 10}, {20, 0, 0, 25}}}})}}))};
  const SceneState state = run(shape, calls, 20, 8);
  double highest = 0;
  for (const Vec3& position : state.positions) {
    EXPECT_GT((position - Vec3(0, 0, 25)).norm(), 2.9);
    highest = std::max(highest, position.z());
  }
  EXPECT_GT(highest, 27) << "the ball has lifted the sheet";
}

TEST(ClothDynamics, FollowsTheVolumeOfItsKeys) {
  const Shape shape = ball({6, 5.0});
  const auto volume_after = [&](int frames) {
    const SceneState state =
        run(shape, {call("cloth_dynamics", laws({{"volume", Table{{0, 1}, {20, 0.5}}}}))}, frames, 16);
    double six = 0;
    for (const Triangle& t : shape.triangles)
      six += state.positions[+t[0]].dot(state.positions[+t[1]].cross(state.positions[+t[2]]));
    return six / 6;
  };
  EXPECT_NEAR(volume_after(25) / volume_after(0), 0.5, 0.02);
}

// A ball on one bone, under a skirt whose band rests over its upper half.
Shape skirted_ball() {
  Shape shape = ball({10, 2.6});
  shape.rig = {{BoneId{-1}}, {{Vec3(0, 0, -1), Vec3(0, 0, 1)}}};
  shape.bone_names = {"middle"};
  for (JointWeights& weights : shape.weights) weights.bone[0] = BoneId{0}, weights.weight[0] = 1;
  add_skirt({3, 1, 0.5, 7, 20, 1, Vec3(0, 0, 6.5)}, shape, "test");
  return shape;
}

TEST(ClothDynamics, MovesWhatABodyWearsAndKeepsItOffTheBody) {
  const Shape shape = skirted_ball();
  const std::size_t body = ball({10, 2.6}).positions.size();
  const auto swung = [&](Values more) {
    more.insert({"thickness", 0.45});
    return run(shape,
               {call("keyframes", {{"middle", Table{{0, 0, 0, 0}, {20, 0, 0, 0.1}, {40, 0, 0, -0.1}}},
                                   {"root", Table{{0, 0, 0, 0}, {20, 3, 0, 0}, {40, 0, 0, 1}}}}),
                call("skinning_linear"), call("cloth_dynamics", laws(std::move(more)))},
               40, 16);
  };
  const SceneState state = swung({{"body_gap", 0.4}});
  const SceneState bare =
      run(shape,
          {call("keyframes", {{"middle", Table{{0, 0, 0, 0}, {20, 0, 0, 0.1}, {40, 0, 0, -0.1}}},
                              {"root", Table{{0, 0, 0, 0}, {20, 3, 0, 0}, {40, 0, 0, 1}}}}),
           call("skinning_linear")},
          40, 16);
  double lowest = 0, nearest = 1e300;
  for (std::size_t v = 0; v < shape.positions.size(); ++v) {
    const bool has_bones = shape.weights[v].has_bones();
    if (has_bones) {
      expect_near(state.positions[v], bare.positions[v]);
    } else {
      EXPECT_EQ(bare.positions[v], shape.positions[v]) << "skinning leaves cloth alone";
    }
    if (v < body) continue;
    lowest = std::min(lowest, state.positions[v].z() - 1 - shape.positions[v].z());
    if (!has_bones) nearest = std::min(nearest, (state.positions[v] - Vec3(0, 0, 1)).norm());
  }
  EXPECT_LT(lowest, -0.2) << "the skirt has fallen";
  EXPECT_GT(nearest, 2.58 + 0.4 - 0.1);
  double through = 1e300;
  const SceneState free = swung({});
  for (std::size_t v = body; v < shape.positions.size(); ++v)
    through = std::min(through, (free.positions[v] - Vec3(0, 0, 1)).norm());
  EXPECT_LT(through, 2.5) << "without a gap the cloth does not know the body";
  EXPECT_EQ(swung({{"body_gap", 0.4}}).positions, state.positions) << "each run gives the same frames";
}

TEST(ClothDynamics, RefusesWhatItCannotDo) {
  const Shape shape = small_sheet();
  const auto refused = [&](Values more) {
    return refusal(shape, call("cloth_dynamics", laws(std::move(more))));
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_NE(refused({{"body_gap", 0.5}}).find("needs a shape with a body"), std::string::npos);
  const Shape worn = skirted_ball();
  EXPECT_EQ(refusal(worn, call("cloth_dynamics", laws({{"body_gap", 0.5}}))), "");
  EXPECT_NE(refusal(worn, call("cloth_dynamics", laws({{"body_gap", 0.0}}))).find("body_gap is 0"),
            std::string::npos);
  EXPECT_NE(refused({{"grips", one(grip({{0, 0, 0, 0}}, 99))}}).find("no vertex at rest lies between"),
            std::string::npos);
  EXPECT_NE(refused({{"volume", Table{{0, 1}}}}).find("parameter volume"), std::string::npos)
      << "an open surface holds no volume";
  EXPECT_NE(refused({{"balls", one({{"radius", 1.0}})}}).find("path is missing"), std::string::npos);
  EXPECT_NE(
      refused({{"balls", one({{"radius", 1.0}, {"path", Table{{0, 0, 0}}}})}}).find("path has a row of 3"),
      std::string::npos);
}

}  // namespace
}  // namespace cscd::scenes
