// Long steps, which drvbc_fast looks at in parts ("Theorem: an interval in parts" in core/soundness.md),
// against the same steps looked at as a whole.

#include <gtest/gtest.h>
#include <utility>

#include "bench/strategies/catalogue.h"
#include "bench/testing/random_step.h"
#include "core/fast/drvbc_fast.h"
#include "core/mesh/test_shapes.h"

namespace cscd::bench {
namespace {

constexpr std::uint32_t kAlways = 0, kNever = DrvbcFastOptions::kNever;

// CSCD_PARTS tries another number of intervals.
std::uint64_t part_seeds() {
  return test::steps_asked("CSCD_PARTS", 400);
}

struct LongStep : test::RandomStep {
  using RandomStep::RandomStep;
  Prepared prepared(const DrvbcFastOptions& options, int threads = 1) const {
    return make_drvbc_fast({mesh, start, nullptr, elementary_test_named("exact"), threads}, options);
  }
};

void expect_same(const ContactSet& a, const ContactSet& b, std::uint64_t seed) {
  ASSERT_EQ(a.contacts.size(), b.contacts.size()) << "seed " << seed;
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].pair, b.contacts[i].pair) << "seed " << seed;
    EXPECT_EQ(a.contacts[i].time, b.contacts[i].time);
  }
}

// Mutations: the last part is left out; pairs of a part whose descent was broken off are kept in place of
// those of its halves; a pair that several parts find is passed on several times.
TEST(Parts, KeepEveryContactOfLongSteps) {
  std::size_t in_parts = 0, contacts = 0, crossings = 0;
  for (std::uint64_t seed = 1; seed <= part_seeds(); ++seed) {
    LongStep step(seed);
    if (seed % 2 == 0) std::swap(step.start, step.end);  // may cross itself at the start
    ContactSet found[2];
    Crossings crossing[2];
    Report report[2];
    for (const bool in_two : {false, true}) {
      const auto detector =
          step.prepared({.follows = false, .long_descent = in_two ? kAlways : kNever, .complete = true})
              .detector;
      report[in_two] = detector->detect(
          {.motion = step.motion(), .crossings = &crossing[in_two], .most_crossings = 1 << 20},
          found[in_two]);
      found[in_two].sort();
      std::ranges::sort(crossing[in_two].pairs);
    }
    expect_same(found[0], found[1], seed);
    EXPECT_EQ(crossing[0].total, crossing[1].total);
    EXPECT_EQ(crossing[0].pairs, crossing[1].pairs);
    in_parts += report[0].cull.bvot != report[1].cull.bvot;
    contacts += found[0].contacts.size();
    crossings += crossing[0].total;
  }
  EXPECT_GT(in_parts, 20u);
  EXPECT_GT(contacts, 1000u);
  EXPECT_GT(crossings, 1000u);
}

// Mutation: a part is looked at from the observers of the part before it.
TEST(Parts, KeepTheFirstContactOfLongSteps) {
  std::size_t in_parts = 0, touching = 0;
  for (std::uint64_t seed = 1; seed <= part_seeds(); ++seed) {
    const LongStep step(seed);
    if (!step.mesh.closed_and_oriented() || !step.starts_embedded()) continue;
    ContactSet whole, found;
    step.prepared({.long_descent = kNever, .complete = true}).detector->detect({step.motion()}, whole);
    const Report in =
        step.prepared({.follows = false, .long_descent = kAlways}).detector->detect({step.motion()}, found);
    ContactSet unsplit;
    const Report out =
        step.prepared({.follows = false, .long_descent = kNever}).detector->detect({step.motion()}, unsplit);
    whole.sort(), found.sort();
    keep_first(whole), keep_first(found);
    EXPECT_EQ(whole.contacts.empty(), found.contacts.empty()) << "seed " << seed;
    if (!whole.contacts.empty() && !found.contacts.empty()) {
      EXPECT_EQ(whole.contacts.front().time, found.contacts.front().time) << "seed " << seed;
    }
    touching += !whole.contacts.empty();
    in_parts += in.cull.bvot != out.cull.bvot;
  }
  EXPECT_GT(in_parts, 20u);
  EXPECT_GT(touching, 50u);
}

// Mutation: the tests of a descent that was broken off are counted as far as its threads came.
TEST(Parts, AreTheSameOnAnyNumberOfThreads) {
  std::size_t in_parts = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const LongStep step(seed);
    ContactSet alone, both, whole;
    const Report one = step.prepared({.long_descent = kAlways, .complete = true}, 1)
                           .detector->detect({step.motion()}, alone);
    const Report two =
        step.prepared({.long_descent = kAlways, .complete = true}, 2).detector->detect({step.motion()}, both);
    const Report other =
        step.prepared({.long_descent = kNever, .complete = true}).detector->detect({step.motion()}, whole);
    EXPECT_EQ(one.cull.bvot, two.cull.bvot) << "seed " << seed;
    EXPECT_EQ(one.cull.pctp, two.cull.pctp) << "seed " << seed;
    expect_same(alone, both, seed);
    in_parts += one.cull.bvot != other.cull.bvot;
  }
  EXPECT_GT(in_parts, 5u);
}

// Mutation: how far the surface moves is not asked.
TEST(Parts, AreMadeOfStepsThatMoveFar) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    LongStep step(seed);
    for (std::size_t v = 0; v < step.start.size(); ++v)
      step.end[v] = step.start[v] + 1e-3 * (step.end[v] - step.start[v]);
    ContactSet found;
    Report report[2];
    for (const bool in_two : {false, true})
      report[in_two] = step.prepared({.long_descent = in_two ? kAlways : kNever, .complete = true})
                           .detector->detect({step.motion()}, found);
    EXPECT_EQ(report[0].cull.bvot, report[1].cull.bvot) << "seed " << seed;
  }
}

// A vertex flies through the middle of an edge at t = 1/2, where z is 2^52 and a half for one end of the edge
// and for the vertex. Rounded to whole numbers, as doubles of that size are, the vertex passes beside the
// edge. Mutation: the rounding of positions between the ends is left out of the error.
TEST(Parts, KeepAContactThatRoundingHides) {
  constexpr double kFar = 0x1p52;
  const std::vector<Triangle> triangles = {test::corners(0, 1, 2), test::corners(3, 4, 5)};
  const TriangleMesh mesh(triangles, 6);
  std::vector<Vec3> start = {{0, 0, 0},      {2, -2, 2},      {1, -1, -39},
                             {-99, -101, 1}, {-96, -101, 41}, {-102, -101, 41}};
  std::vector<Vec3> end = start;
  for (Vec3& p : end) p.z() += 1;
  for (const std::size_t v : {3, 4, 5}) end[v] += Vec3(200, 200, 0);
  for (const auto positions : {&start, &end})
    for (Vec3& p : *positions) p.z() += kFar;
  for (const std::uint32_t long_descent : {kAlways, kNever}) {
    ContactSet found;
    make_drvbc_fast({mesh, start, nullptr, elementary_test_named("exact")},
                    {.long_descent = long_descent, .complete = true})
        .detector->detect({Motion(start, end)}, found);
    EXPECT_EQ(found.contacts.size(), 3u) << "with the face, and of two edges at the vertex with the edge";
    for (const Contact& contact : found.contacts) EXPECT_EQ(contact.time, 0.5);
  }
}

// A ball turns farther and farther away from the origin, and positions between the ends are known less and
// less. Both ends are given, so the step can be answered as a whole. Mutation: parts are looked at all the
// same; all pairs of triangles are then tested.
TEST(Parts, AreGivenUpWhereRoundingHidesTheSurface) {
  const test::Shape ball = test::icosphere(3);
  const TriangleMesh mesh = ball.mesh();
  for (const double far : {0.0, 1e9, 1e11, 1e12, 2e12, 5e12, 2e13}) {
    std::vector<Vec3> start = ball.positions, end = start;
    for (Vec3& p : end) p = Eigen::AngleAxisd(2.5 * p.z(), Vec3::UnitZ()) * p;
    for (const auto positions : {&start, &end})
      for (Vec3& p : *positions) p.x() += far;
    for (const std::uint32_t long_descent : {kAlways, kNever}) {
      ContactSet found;
      const Report report = make_drvbc_fast({mesh, start, nullptr, elementary_test_named("exact")},
                                            {.long_descent = long_descent, .complete = true})
                                .detector->detect({Motion(start, end)}, found);
      EXPECT_LT(report.cull.pctp, mesh.triangle_count() * 30) << far << ", " << long_descent;
    }
  }
}

}  // namespace
}  // namespace cscd::bench
