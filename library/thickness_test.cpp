#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/base/test_memory.h"
#include "core/base/test_refusal.h"
#include "library/test_steps.h"

// Holds the answers at a thickness to a search of all feature pairs.
namespace cscd {
namespace {

using namespace test;
using Options = SelfCollision::Options;

// A thickness for a random step: one for all, or drawn for each vertex, from less than an edge to more.
void draw_thickness(std::uint64_t seed, std::size_t vertices, Options& options) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  const double length = 0.3 * std::pow(share(random), 3);
  if (seed % 3 != 0) options.thickness = length;
  if (seed % 3 == 1) return;
  for (std::size_t v = 0; v < vertices; ++v) options.vertex_thickness.push_back(0.5 * length * share(random));
}

// Excludes what is close by construction, every second time.
void draw_exclusions(std::uint64_t seed, const SceneStep& step, Options& options, Exclusions& expected) {
  if (seed % 4 == 1) {
    options.exclude.rings = 1;
    expected.exclude_rings(step.mesh, 1);
  } else if (seed % 4 == 3) {
    options.exclude.rest_distance = 0.2;
    expected.exclude_near(step.all_start, 0.2);
  }
}

// Mutations: contacts are not looked at while they are gathered; candidates are not.
TEST(Thickness, SaysSoBeforePairsTakeMoreMemoryThanThereIs) {
  if (!test::memory_can_be_limited()) GTEST_SKIP() << "memory cannot be limited here";
  constexpr int kSide = 20;
  constexpr double kFar = 4.5;  // edges
  FaceRows faces(4 * kSide * kSide, 3);
  Rows pose(2 * (kSide + 1) * (kSide + 1), 3);
  for (int sheet = 0, v = 0, f = 0; sheet < 2; ++sheet)
    for (int i = 0; i <= kSide; ++i)
      for (int j = 0; j <= kSide; ++j, ++v) {
        pose.row(v) << i, j, 0.4 * sheet + 0.01 * std::sin(v);
        if (i == kSide || j == kSide) continue;
        faces.row(f++) << v, v + kSide + 1, v + 1;
        faces.row(f++) << v + 1, v + kSide + 1, v + kSide + 2;
      }
  Options options;
  options.thickness = kFar;
  SelfCollision body(faces, pose, options);
  body.is_free(pose, pose), body.candidates(pose, pose, 0);  // prepare
  const auto refused = [&](const auto& ask) {
    const MemoryLimit limit(32 << 20);
    return refusal<std::bad_alloc>(ask);
  };
  const std::string contacts = refused([&] { body.all_contacts(pose, pose); }),
                    candidates = refused([&] { body.candidates(pose, pose, 4 * kFar); });
  for (const std::string& why : {contacts, candidates}) {
    EXPECT_TRUE(why.find(" pairs of features are near enough so far, and going on takes ") != why.npos ||
                why.starts_with("testing the pairs of features that may be near takes "))
        << why;
    EXPECT_NE(why.find("give a smaller thickness or radius"), std::string::npos) << why;
  }
  EXPECT_GT(body.all_contacts(pose, pose).contacts.size(), 300'000u) << "with as much memory as it takes";
}

TEST(Thickness, AnswersRandomStepsAsASearchOfAllFeaturePairsDoes) {
  std::size_t free = 0, close_at_start = 0, close_later = 0;
  for (std::uint64_t seed = 1; seed <= intervals() / 2; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SceneStep step = seed % 5 == 0 ? beside(seed) : SceneStep(seed);
    const bool obstacle = step.own() < step.mesh.vertex_count();
    Exclusions exclusions = obstacle ? obstacle_against_obstacle(step) : Exclusions();
    Options options;
    if (obstacle) options.obstacles.push_back(obstacle_of(step, step.beside(step.all_start)));
    draw_thickness(seed, step.mesh.vertex_count(), options);
    draw_exclusions(seed, step, options, exclusions);
    const Thickness thickness(options.thickness, options.vertex_thickness);
    SelfCollision body(step.faces, step.start, options);
    if (obstacle) body.move_obstacle(0, step.beside(step.all_start), step.beside(step.all_end));
    expect_right(step, body, exclusions, thickness);
    const SelfCollision::Answer all = body.all_contacts(step.start, step.end);
    free += all.free();
    close_at_start += all.close_at_start() > 0;
    close_later += all.close_at_start() < all.contacts.size();
    for (const SelfCollision::Contact& contact : all.contacts) EXPECT_TRUE(contact.point.allFinite());
    if (!obstacle) {  // and back again
      std::swap(step.all_start, step.all_end), std::swap(step.start, step.end);
      expect_right(step, body, exclusions, thickness);
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(free, intervals() / 40);
  EXPECT_GT(close_at_start, intervals() / 10);
  EXPECT_GT(close_later, intervals() / 10);
}

const FaceRows kTwoFaces{{0, 1, 2}, {3, 4, 5}};
// One triangle lies two above another, and comes as near as 0.5.
const Rows kApart{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 2}, {2, 1, 2}, {1, 2, 2}};
Rows after() {
  Rows out = kApart;
  out.bottomRows(3).col(2).setConstant(0.5);
  return out;
}

Options thick(double thickness, std::vector<double> by_vertex = {}) {
  Options out;
  out.thickness = thickness;
  out.vertex_thickness = std::move(by_vertex);
  return out;
}

TEST(Thickness, SaysWhereFeaturesAreNearest) {
  SelfCollision body(kTwoFaces, kApart, thick(1));
  EXPECT_FALSE(body.is_free(kApart, after()));
  const SelfCollision::Answer first = body.first_contact(kApart, after());
  ASSERT_FALSE(first.contacts.empty());
  EXPECT_NEAR(*first.time(), 2.0 / 3, 1e-15);
  for (const SelfCollision::Contact& contact : first.contacts) {
    EXPECT_NEAR(std::abs(contact.normal.z()), 1, 1e-12);
    EXPECT_NEAR(contact.normal_velocity, -1.5, 1e-12) << "the two approach";
  }
  const double t = body.largest_step(kApart, after(), 1);
  EXPECT_GT(t, 2.0 / 3 - 1e-14);
  const Rows end = kApart + t * (after() - kApart);
  EXPECT_TRUE(body.is_free(kApart, end));
  EXPECT_TRUE(SelfCollision(kTwoFaces, kApart, thick(0.499)).is_free(kApart, after()));
  EXPECT_EQ(SelfCollision(kTwoFaces, kApart, thick(3)).largest_step(kApart, after()), 0);
}

// Mutations: the box of the mesh does not grow, nor do the boxes of its triangles.
TEST(Thickness, ReachesToObstacles) {
  const FaceRows face{{0, 1, 2}};
  const Rows start = kApart.bottomRows(3), end = after().bottomRows(3);
  for (const bool by_vertex : {false, true}) {
    Options options = by_vertex ? thick(0, {0.25, 0.25, 0.25, 0.75, 0.75, 0.75}) : thick(1);
    options.obstacles.emplace_back(face, kApart.topRows(3));
    SelfCollision body(face, start, options);
    const SelfCollision::Answer first = body.first_contact(start, end);
    EXPECT_NEAR(first.time().value_or(2), 2.0 / 3, 1e-15);
    EXPECT_EQ(first.close_at_start(), 0u);
    EXPECT_FALSE(body.is_free(start, end));
    EXPECT_GT(body.all_contacts(end, end).close_at_start(), 0u);
    EXPECT_TRUE(body.is_free(start, start));
  }
}

// The exact sum 1 + 2^-53 is no double. Mutation: the sum is rounded to the nearest.
TEST(Thickness, SumsOfAPairAreRoundedUp) {
  Rows pose = kApart;
  pose.topRows(3).col(2).setConstant(-0x1p-53);
  pose.bottomRows(3).col(2).setConstant(1);
  SelfCollision body(kTwoFaces, kApart, thick(1, {0x1p-53, 0x1p-53, 0x1p-53, 0, 0, 0}));
  EXPECT_GT(body.all_contacts(pose, pose).close_at_start(), 0u);
  pose.bottomRows(3).col(2).setConstant(1 + 0x1p-51);
  EXPECT_TRUE(body.is_free(pose, pose));
}

// From less than the square of what a double holds to more than the mesh measures.
TEST(Thickness, ExtremeLengthsAreAnswered) {
  Rows touching = after();
  touching.bottomRows(3).col(2).setConstant(0);
  for (const double length : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e-170}) {
    SelfCollision body(kTwoFaces, kApart, thick(length));
    EXPECT_TRUE(body.is_free(kApart, after())) << length;
    EXPECT_FALSE(body.is_free(kApart, touching)) << length;
    EXPECT_NEAR(body.first_contact(kApart, touching).time().value_or(0), 1, 1e-15) << length;
  }
  for (const double length :
       {10.0, 1e4, 1e8, 1e12, 1e30, 1e39, 1e41, 1e200, 1e300, std::numeric_limits<double>::max()}) {
    SelfCollision body(kTwoFaces, kApart, thick(length));
    EXPECT_EQ(body.all_contacts(kApart, after()).close_at_start(), 15u) << length;
    EXPECT_EQ(body.largest_step(kApart, after()), 0) << length;
  }
}

TEST(Thickness, IsRefusedWhereItIsNoLength) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const auto refused = [](const Options& options, const std::string& text) {
    const std::string said =
        refusal<std::invalid_argument>([&] { SelfCollision(kTwoFaces, kApart, options); });
    EXPECT_NE(said.find(text), std::string::npos) << said;
  };
  for (const double wrong : {nan, inf, -inf, -1.0, -std::numeric_limits<double>::denorm_min()}) {
    refused(thick(wrong), "thickness is");
    refused(thick(0, {0, 0, 0, 0, wrong, 0}), "vertex_thickness of vertex 4 is");
  }
  refused(thick(0, {0, 0, 0, 0, 0}), "5 entries for 6 vertices");
  refused(thick(0, std::vector<double>(6, 1e308)), "thickness of a pair of vertices is inf");
}

}  // namespace
}  // namespace cscd
