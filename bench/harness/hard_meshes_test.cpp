// Hard cases of whole meshes that no rule of core/soundness.md names: every strategy that promises
// something is held to it against all pairs, with an exact test behind it.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "bench/strategies/catalogue.h"
#include "bench/strategies/verify.h"
#include "core/detect/start/embedding.h"
#include "core/mesh/test_shapes.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

using test::Shape;

template <class Map>
std::vector<Vec3> mapped(const std::vector<Vec3>& positions, const Map& map) {
  std::vector<Vec3> out;
  for (const Vec3& p : positions) out.push_back(map(p));
  return out;
}

struct Found {
  std::size_t contacts;
  double first;
};

// Runs them all; returns what is true. Strategies with bones get one, from `head` to `tail`.
Found hold_to_promises(const Shape& shape, const std::vector<Vec3>& end, const Vec3& head, const Vec3& tail,
                       bool with_bones = true) {
  const TriangleMesh mesh = shape.mesh();
  const ElementaryTest &exact = elementary_test_named("exact"),
                       &ours = elementary_test_named("filtered_exact");
  const Bone bone{head, tail};
  const Rig rig{{BoneId{-1}}, {bone}};
  const std::vector<Bone> bones_end{bone};
  const Rig::Interval bones{rig.reference, bones_end};
  const Motion motion(shape.positions, end);
  const bool embedded = EmbeddingTest(mesh, shape.positions).embedded(shape.positions);
  ContactSet truth;
  const StrategyInput judged{mesh, shape.positions, &rig, exact}, asked{mesh, shape.positions, &rig, ours},
      boneless{mesh, shape.positions, nullptr, ours};
  all_pairs().make(judged).detector->detect({motion, &bones}, truth);
  truth.sort();
  for (const Strategy& strategy : strategies()) {
    if (strategy.guarantee == Guarantee::heuristic ||
        (strategy.needs == Needs::closed_mesh_with_bones && !with_bones))
      continue;
    ContactSet answer;
    strategy.make(with_bones ? asked : boneless).detector->detect({motion, &bones}, answer);
    answer.sort();
    const Verification judgement = verify(truth, answer, strategy.guarantee, embedded);
    EXPECT_TRUE(judgement.ok) << strategy.name << ": " << judgement.failure;
  }
  return {truth.contacts.size(), truth.contacts.empty() ? 2 : truth.contacts.front().time};
}

const Vec3 kHead(-0.1, 0, 0), kTail(0.1, 0, 0);

// A half turn between the two ends within one interval: every ring of the second half goes through the axis.
TEST(HardMeshes, CandyWrapperTwist) {
  const Shape tube = test::capped_tube(9, 16, 0.5, 4);
  double low = 1e9, high = -1e9;
  for (const Vec3& p : tube.positions) low = std::min(low, p.x()), high = std::max(high, p.x());
  for (const double turns : {0.25, 0.5, 0.75}) {
    const std::vector<Vec3> end = mapped(tube.positions, [&](const Vec3& p) {
      const double angle = 2 * std::numbers::pi * turns * (p.x() - low) / (high - low);
      const double c = std::cos(angle), s = std::sin(angle);
      return Vec3(p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z());
    });
    const Found found = hold_to_promises(tube, end, {low, 0, 0}, {high, 0, 0});
    if (turns >= 0.5) {
      EXPECT_GT(found.contacts, 0u) << turns;
    }
  }
}

// Flat exactly at t = 1, or at t = 1/2 and inside out at the end: coplanar features without number.
TEST(HardMeshes, FoldsShutToExactCoplanarity) {
  for (const Shape& shape : {test::octahedron(2), test::box({-1, -1, -1}, {1, 1, 1})})
    for (const double height : {0.0, -1.0}) {
      const std::vector<Vec3> end =
          mapped(shape.positions, [&](const Vec3& p) { return Vec3(p.x(), p.y(), height * p.z()); });
      const Found found = hold_to_promises(shape, end, kHead, kTail);
      EXPECT_GT(found.contacts, 0u);
      EXPECT_EQ(found.first, height == 0 ? 1 : 0.5);
    }
}

// Through a plate in one interval, from far on one side to far on the other.
TEST(HardMeshes, TunnellingInOneInterval) {
  for (const double distance : {4.0, 1024.0, 1048576.0}) {
    const Shape ball = test::moved(test::octahedron(1), {-distance, 0.25, 0.125});
    const Shape shape = test::together(ball, test::box({-0.25, -4, -4}, {0.25, 4, 4}));
    std::vector<Vec3> end = shape.positions;
    for (std::size_t i = 0; i < ball.positions.size(); ++i) end[i].x() += 2 * distance;
    const Found found = hold_to_promises(shape, end, kHead, kTail, distance < 10);
    EXPECT_GT(found.contacts, 0u);
    EXPECT_EQ(found.first, (distance - 1.25) / (2 * distance));
  }
}

// Several pairs of bodies touch at one instant, each at a corner, an edge and a face.
TEST(HardMeshes, SeveralContactsAtOneInstant) {
  Shape shape = test::box({-1, -1, -1}, {1, 1, 1});
  const std::size_t still = shape.positions.size();
  for (const Vec3& way : {Vec3(4, 0, 0), Vec3(-4, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, -4)})
    shape = test::together(shape, test::moved(test::octahedron(1), way));
  std::vector<Vec3> end = shape.positions;
  for (std::size_t i = still; i < end.size(); ++i) {
    const Vec3 centre = shape.positions[still + (i - still) / 6 * 6] - Vec3(1, 0, 0);
    end[i] -= centre;
  }
  const Found found = hold_to_promises(shape, end, kHead, kTail);
  EXPECT_GT(found.contacts, 8u);
  EXPECT_EQ(found.first, 0.5);
}

// Scaling by a power of two, far common motion and far offsets by representable amounts change no answer.
TEST(HardMeshes, ScaleAndPlaceChangeNothing) {
  const Shape ball = test::moved(test::octahedron(1), {3, 0.25, 0.125});
  const Shape shape = test::together(ball, test::box({-1, -2, -2}, {1, 2, 2}));
  std::vector<Vec3> end = shape.positions;
  for (std::size_t i = 0; i < ball.positions.size(); ++i) end[i].x() -= 4;
  const Found here = hold_to_promises(shape, end, kHead, kTail);
  EXPECT_GT(here.contacts, 0u);
  EXPECT_EQ(here.first, 0.25);
  const auto expect_same = [&](const auto& at_start, const auto& at_end, bool with_bones) {
    Shape there = shape;
    there.positions = mapped(shape.positions, at_start);
    const Found found =
        hold_to_promises(there, mapped(end, at_end), at_start(kHead), at_start(kTail), with_bones);
    EXPECT_EQ(found.contacts, here.contacts);
    EXPECT_EQ(found.first, here.first);
  };
  for (const int exponent : {-30, 30, -100, 100}) {
    const auto scale = [&](const Vec3& p) { return Vec3(std::ldexp(1.0, exponent) * p); };
    expect_same(scale, scale, std::abs(exponent) < 50);
  }
  const auto stay = [](const Vec3& p) { return p; };
  const auto far = [](const Vec3& p) { return Vec3(p + Vec3(0x1p30, -0x1p28, 0x1p20)); };
  expect_same(far, far, false);
  expect_same(stay, far, false);
}

// Two triangles whose projections overflow single precision, while bounds of their errors do not.
TEST(HardMeshes, AFilterInSinglePrecisionDropsNothingOfHugeTriangles) {
  const double unit = 1e8;
  const std::vector<Vec3> start =
      mapped({{0, -12, -12}, {-24, 6, -30}, {9, -30, 0}, {9, 27, -6}, {3, 9, -30}, {6, -18, 9}},
             [&](const Vec3& p) { return Vec3(unit * p); });
  const std::vector<Vec3> end =
      mapped({{0, 0, 18}, {0, 30, 0}, {-15, 15, -18}, {-18, 21, 24}, {30, 15, 15}, {27, -24, -12}},
             [&](const Vec3& p) { return Vec3(unit * p); });
  const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
  for (const char* test : {"exact", "filtered_exact"}) {
    ContactSet found;
    complete_reference()
        .make({mesh, start, nullptr, elementary_test_named(test)})
        .detector->detect({Motion(start, end)}, found);
    EXPECT_EQ(found.contacts.size(), 1u) << test;
  }
}

// Scale, of meshes whose features nearly touch at random: at any size, single precision and doubles end
// somewhere else.
TEST(HardMeshes, ScaleChangesNoAnswerOfRandomMeshes) {
  const ElementaryTest &exact = elementary_test_named("exact"),
                       &ours = elementary_test_named("filtered_exact");
  std::size_t contacts = 0;
  for (int exponent = -280; exponent <= 280; exponent += std::abs(exponent) < 60 ? 1 : 10) {
    SCOPED_TRACE(exponent);
    const scenes::RandomInterval random =
        scenes::make_random_interval(static_cast<std::uint64_t>(300 + exponent));
    const auto at = [&](std::size_t frame, double scale) {
      const auto positions = random.clip.frame(frame).positions;
      return mapped({positions.begin(), positions.end()}, [&](const Vec3& p) { return Vec3(scale * p); });
    };
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const auto answer = [&](const char* name, const ElementaryTest& test, double scale) {
      const std::vector<Vec3> start = at(0, scale), end = at(1, scale);
      ContactSet found;
      strategy_named(name).make({mesh, start, nullptr, test}).detector->detect({Motion(start, end)}, found);
      found.sort();
      return found;
    };
    const ContactSet truth = answer("base", exact, 1);
    const bool embedded = EmbeddingTest(mesh, at(0, 1)).embedded(at(0, 1));
    for (const char* name : {"base", "drvbc_fast", "drvbc_fast_complete"}) {
      const Verification judgement = verify(truth, answer(name, ours, std::ldexp(1.0, exponent)),
                                            strategy_named(name).guarantee, embedded);
      EXPECT_TRUE(judgement.ok) << name << ": " << judgement.failure;
    }
    contacts += truth.contacts.size();
  }
  EXPECT_GT(contacts, 1000u);
}

}  // namespace
}  // namespace cscd::bench
