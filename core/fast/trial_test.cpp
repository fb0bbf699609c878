#include "core/fast/trial.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {

namespace {

// A sphere with a spike on each face, and a bone in each spike.
struct Spikes {
  test::Shape shape;
  Rig rig;

  explicit Spikes(int rings) {
    const test::Shape sphere = test::icosphere(1);
    shape.positions = sphere.positions;
    for (const Triangle& face : sphere.triangles) {
      const Vec3 middle =
          (sphere.positions[+face[0]] + sphere.positions[+face[1]] + sphere.positions[+face[2]]) / 3;
      const Vec3 tip = 3 * middle;
      rig.parent.push_back(BoneId{-1});
      rig.reference.push_back({0.8 * middle, tip});
      int below[3] = {static_cast<int>(face[0]), static_cast<int>(face[1]), static_cast<int>(face[2])};
      for (int r = 1; r < rings; ++r) {
        const auto next = static_cast<int>(shape.positions.size());
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3& foot = sphere.positions[+face[k]];
          shape.positions.push_back(foot + (tip - foot) * r / rings);
        }
        for (int k = 0; k < 3; ++k) {
          const int l = (k + 1) % 3;
          shape.triangles.push_back(test::corners(below[k], below[l], next + l));
          shape.triangles.push_back(test::corners(below[k], next + l, next + k));
        }
        for (int k = 0; k < 3; ++k) below[k] = next + k;
      }
      shape.positions.push_back(tip);
      for (int k = 0; k < 3; ++k)
        shape.triangles.push_back(
            test::corners(below[k], below[(k + 1) % 3], static_cast<int>(shape.positions.size()) - 1));
    }
  }
};

// One bone as long as a tube sees little of it. Eight bones see a tube of few rows better than the few slabs
// into which such a surface is cut. Mutations: the trial always takes the clusters of bones; it always takes
// those of the surface.
TEST(Trial, DecidesWhichClustersAreTaken) {
  using Clusters = DrvbcFastOptions::Clusters;
  const auto expect = [](const test::Shape& tube, int bones, Clusters better) {
    const TriangleMesh mesh = tube.mesh();
    const Rig rig = test::straight_chain(bones, {0.5, 0, 0}, {14.5, 0, 0});
    const auto clusters = [&](Clusters wanted) {
      const StrategyInput setup{mesh, tube.positions, &rig, elementary_tests().front()};
      return make_drvbc_fast(setup, {.clusters = wanted}).preparation.atomic_cluster;
    };
    EXPECT_NE(clusters(Clusters::of_bones), clusters(Clusters::of_surface));
    EXPECT_EQ(clusters(Clusters::by_trial), clusters(better)) << bones;
  };
  const auto tube = [](int rings) {
    return test::uneven_tube(12, rings, 15, [](double x) { return 0.8 + 0.1 * std::sin(3 * x); });
  };
  expect(tube(70), 1, Clusters::of_surface);
  expect(tube(40), 8, Clusters::of_bones);
}

// Where clusters are only a few patches, seams are everywhere, and covers beside the first cost more than
// they save. Mutation: all covers are always used.
TEST(Trial, DecidesHowManyCoversAreUsed) {
  const auto observers = [](const test::Shape& shape, const Rig& rig, DrvbcFastOptions options) {
    const TriangleMesh mesh = shape.mesh();
    const StrategyInput setup{mesh, shape.positions, &rig, elementary_tests().front()};
    ContactSet found;
    return make_drvbc_fast(setup, options)
        .detector->detect({Motion(shape.positions, shape.positions)}, found)
        .cull.radial->clusters;
  };
  const Spikes spikes(7);
  EXPECT_EQ(observers(spikes.shape, spikes.rig, {}), observers(spikes.shape, spikes.rig, {.covers = 1}));
  EXPECT_GT(observers(spikes.shape, spikes.rig, {.clusters = DrvbcFastOptions::Clusters::of_bones}), 100u)
      << "there are others";
  const test::Body tube(0, 0);
  EXPECT_GT(observers(tube.shape, tube.rig, {}), observers(tube.shape, tube.rig, {.covers = 1}));
}

Prepared prepared(const test::Body& body, const Rig& rig, int threads) {
  return make_drvbc_fast({body.mesh, body.shape.positions, &rig, elementary_tests().front(), threads}, {});
}

// Mutation: the candidate that is ready first is taken.
TEST(Trial, TakesTheSameOnAnyNumberOfThreads) {
  const test::Body tube(0, 0);
  for (const int bones : {1, 15}) {
    const Rig rig = test::straight_chain(bones, {0.5, 0, 0}, {14.5, 0, 0});
    const Preparation alone = prepared(tube, rig, 1).preparation, both = prepared(tube, rig, 2).preparation;
    EXPECT_EQ(alone.atomic_cluster, both.atomic_cluster);
    EXPECT_TRUE(both.distance_and_heat_ms.has_value());
  }
}

// Mutation: what a thread throws is lost.
TEST(Trial, SaysWhatAThreadCouldNotPrepare) {
  test::Body tube(0, 0);
  const Rig rig = test::straight_chain(15, {0.5, 0, 0}, {14.5, 0, 0});
  tube.shape.positions[7].x() = std::numeric_limits<double>::infinity();
  for (const int threads : {1, 2}) EXPECT_THROW(prepared(tube, rig, threads), InputError);
}

std::vector<BoneId> bones_of(const test::Body& body) {
  std::vector<BoneId> bone_of;
  for (const std::int32_t c : body.atomic.of_triangle)
    bone_of.push_back(body.atomic.clusters[static_cast<std::size_t>(c)].bone);
  return bone_of;
}

// Bones turn with their parents, and the surface keeps its lengths. Mutation: a bone turns without its
// parent.
TEST(TrialPoses, ALimbFollowsItsParentsAndKeepsItsLength) {
  const test::Body body(0, 0);
  const std::vector<BoneId> bone_of = bones_of(body);
  const std::vector<PosePair> trials = trial_poses(body.mesh, body.shape.positions, body.rig, bone_of, 4);
  ASSERT_EQ(trials.size(), 4u);
  const std::vector<Vec3>& at_rest = body.shape.positions;
  const auto length = [&](const std::vector<Vec3>& positions) {
    double sum = 0;
    for (const Triangle& c : body.mesh.triangles()) sum += (positions[+c[0]] - positions[+c[1]]).norm();
    return sum;
  };
  for (const PosePair& trial : trials)
    for (const std::vector<Vec3>& positions : trial) {
      ASSERT_EQ(positions.size(), at_rest.size());
      EXPECT_GT((positions.back() - at_rest.back()).norm(), 1) << "the last bone is far from the root";
      EXPECT_NEAR(length(positions) / length(at_rest), 1, 0.1);
    }
  EXPECT_NE(trials[0][0].back(), trials[0][1].back());
  EXPECT_NE(trials[0][0].back(), trials[1][0].back());
}

}  // namespace

}  // namespace cscd::fast
