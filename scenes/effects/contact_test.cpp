#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/detect/start/embedding.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"
#include "scenes/effects/contact_response.h"
#include "scenes/shape/circle.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {
namespace {

// A detector that tests every feature pair, without any culling.
class AllPairs final : public Detector {
 public:
  explicit AllPairs(const TriangleMesh& mesh) : mesh_(mesh) {}
  Report detect(const Step& step, ContactSet& out) override {
    const Motion& motion = step.motion;
    out.clear();
    const auto look = [&](const FeaturePair& pair) {
      const Answer answer = ask(*find_elementary_test("exact"), mesh_, motion, pair);
      if (answer.verdict != Verdict::apart) out.contacts.push_back({pair, answer.verdict, answer.time});
    };
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh_.triangle_count()); ++t)
      for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh_.vertex_count()); ++v) {
        const Triangle& c = mesh_.corners(TriangleId{t});
        if (std::ranges::find(c, VertexId{v}) == c.end()) look(FeaturePair::of(VertexId{v}, TriangleId{t}));
      }
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh_.edge_count()); ++e)
      for (std::int32_t f = e + 1; f < static_cast<std::int32_t>(mesh_.edge_count()); ++f) {
        const Edge &a = mesh_.ends(EdgeId{e}), &b = mesh_.ends(EdgeId{f});
        if (a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1])
          look(FeaturePair::of(EdgeId{e}, EdgeId{f}));
      }
    return {};
  }

 private:
  const TriangleMesh& mesh_;
};

// Two balls lie beside each other, and the prediction drives the left ball into the right ball.
class TwoBalls : public testing::Test {
 protected:
  static constexpr double kGap = 0.1;
  TwoBalls()
      : balls(test::together(test::icosphere(1), test::moved(test::icosphere(1), {2 + kGap, 0.1, 0.2}))),
        mesh(balls.mesh()),
        one(balls.positions.size() / 2) {}

  std::vector<Vec3> predicted(double advance) const {
    std::vector<Vec3> x = balls.positions;
    for (std::size_t v = 0; v < one; ++v) x[v].x() += advance;
    return x;
  }
  ContactStep step(const ContactStepOptions& options) const {
    return ContactStep(mesh, balls.positions, std::make_unique<AllPairs>(mesh),
                       std::make_unique<AllPairs>(mesh), options);
  }
  bool free(const std::vector<Vec3>& end) {
    ContactSet found;
    AllPairs(mesh).detect({Motion(balls.positions, end)}, found);
    return found.contacts.empty();
  }
  test::Shape balls;
  TriangleMesh mesh;
  std::size_t one;  // number of vertices of the left ball
};

TEST_F(TwoBalls, AStepThatMeetsNothingIsThePrediction) {
  ContactStep contact = step({});
  std::vector<Vec3> end = predicted(0.05);
  contact.resolve(balls.positions, end, {});
  EXPECT_EQ(end, predicted(0.05));
  EXPECT_EQ(contact.counts().colliding, 0u);
}

TEST_F(TwoBalls, AStepThatMeetsStopsThereAndIsPushedApart) {
  ASSERT_FALSE(free(predicted(0.4)));
  ContactStep contact = step({.push = 0.1, .spread = 1.5, .back_off = 0.8, .rounds = 20});
  std::vector<Vec3> end = predicted(0.4);
  contact.resolve(balls.positions, end, {});
  EXPECT_TRUE(free(end));
  EXPECT_EQ(contact.counts().colliding, 1u);
  EXPECT_EQ(contact.counts().cut, 0u);
  double left = 0, right = 0,
         back = 0;  // largest moves from the prediction: left ball, right ball, far side of the left ball
  for (std::size_t v = 0; v < end.size(); ++v) {
    const double moved = (end[v] - predicted(0.4)[v]).norm();
    (v < one ? left : right) = std::max(v < one ? left : right, moved);
    if (balls.positions[v].x() < -0.8) back = std::max(back, moved);
  }
  EXPECT_GT(left, 0.05) << "both sides give way";
  EXPECT_GT(right, 0.05);
  EXPECT_EQ(back, 0) << "far from the contact nothing is felt";
}

TEST_F(TwoBalls, AStepThatIsNotCorrectedIsCutAsAWholeBeforeItsFirstContact) {
  ContactStep contact = step({.push = 0, .spread = 1, .back_off = 0.5, .rounds = 0});
  std::vector<Vec3> end = predicted(0.4);
  contact.resolve(balls.positions, end, {});
  EXPECT_TRUE(free(end));
  EXPECT_EQ(contact.counts().cut, 1u);
  const double moved = end[0].x() - balls.positions[0].x();
  EXPECT_GT(moved, 0.5 * kGap);
  EXPECT_LT(moved, 0.25);
  for (std::size_t v = 0; v < one; ++v) EXPECT_NEAR(end[v].x() - balls.positions[v].x(), moved, 1e-15);
}

// A tube is wound up into a ring until its ends would go through each other.
class Ring : public testing::Test {
 protected:
  Ring() {
    TubeParameters p;
    p.rings = 30;
    p.sides = 6;
    p.bones = 4;
    p.radius = 0.5;
    p.length = 12;
    shape = tube(p);
  }
  // The outcome of 40 frames of the effect: the refusal, the frames whose prediction collided, and the
  // frames done.
  struct Outcome {
    std::string refusal;
    std::size_t colliding = 0, frames = 0;
  };
  Outcome run(const MakeDetector& first) const {
    const auto row = std::ranges::find(effects(), "contact_response", &EffectRow::name);
    const Parameters parameters =
        checked({"scene ring, effect contact_response", {{"push", 0.2}, {"spread", 4.0}}}, row->parameters);
    const TriangleMesh mesh(shape.triangles, shape.positions.size());
    EmbeddingTest embedding(mesh, shape.positions);
    Outcome outcome;
    try {
      const auto effect = make_contact_response(parameters, shape, first);
      SceneState state(shape);
      for (int frame = 1; frame <= 40; ++frame) {
        const std::vector<Vec3> start = state.positions;
        state.time = frame;
        state.positions = wound(frame / 30.0);
        effect->step(state);
        ++outcome.frames;
        EXPECT_TRUE(embedding.embedded(state.positions)) << "frame " << frame;
        outcome.colliding += state.positions != state.predicted;
        EXPECT_EQ(state.predicted.size(), start.size());
      }
    } catch (const InputError& error) {
      outcome.refusal = error.what();
    }
    return outcome;
  }
  std::vector<Vec3> wound(double turns) const {
    const double length = 12, radius = length / (2 * std::numbers::pi * turns);
    std::vector<Vec3> x;
    for (const Vec3& p : shape.positions) {
      const CirclePoint c = circle_point(turns * p.z() / length);
      x.emplace_back((radius + p.x()) * c.cosine - radius, p.y(), (radius + p.x()) * c.sine);
    }
    return x;
  }
  Shape shape;
};

std::unique_ptr<Detector> own(const StrategyInput& setup) {
  return make_drvbc(setup).detector;
}

// Mutation: a detector that loses its contacts every `every`-th time it finds some.
class Forgetful final : public Detector {
 public:
  Forgetful(std::unique_ptr<Detector> detector, int every) : detector_(std::move(detector)), every_(every) {}
  Report detect(const Step& step, ContactSet& out) override {
    const Report report = detector_->detect(step, out);
    if (!out.contacts.empty() && ++found_ % every_ == 0) out.clear();
    return report;
  }

 private:
  std::unique_ptr<Detector> detector_;
  int every_, found_ = 0;
};

TEST_F(Ring, EveryStartIsEmbeddedAndPredictionsCollide) {
  const Outcome outcome = run(own);
  EXPECT_EQ(outcome.refusal, "");
  EXPECT_EQ(outcome.frames, 40u);
  EXPECT_GT(outcome.colliding, 5u);
  EXPECT_LT(outcome.colliding, 30u) << "nothing touches at first";
}

TEST_F(Ring, ADetectorThatMissesContactsLeadsToAStartThatIsRefused) {
  for (const int every : {1, 4}) {
    const Outcome outcome =
        run([&](const StrategyInput& setup) { return std::make_unique<Forgetful>(own(setup), every); });
    EXPECT_EQ(outcome.refusal.find("scene ring, effect contact_response: frame "), 0u) << outcome.refusal;
    EXPECT_NE(outcome.refusal.find("no embedded start"), std::string::npos) << outcome.refusal;
    EXPECT_LT(outcome.frames, 40u);
  }
}

TEST_F(Ring, AShapeThatMeetsItselfAtRestIsRefused) {
  shape.positions[40] = shape.positions[100];
  EXPECT_NE(run(own).refusal.find("frame 0: triangles "), std::string::npos);
}

}  // namespace
}  // namespace cscd::scenes
