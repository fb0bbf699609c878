#include "core/fast/adaptive_cover.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#include <set>

#include "core/fast/contour/test_touching.h"
#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

// One interval of a culler, put together from the rooms below, without any descent.
class Interval {
 public:
  Interval(const TriangleMesh& mesh, std::span<const Vec3> reference, bool complete)
      : mesh_(mesh),
        cut_(cut_surface(mesh, reference, std::vector<std::int32_t>(mesh.triangle_count(), 0))),
        local_(reference),
        certificates_(mesh, cut_.tree, cut_.covers,
                      complete ? capped(reference) : std::vector<CappedClusters>{}),
        following_(mesh, reference, cut_) {}

  void ask(const Motion& motion) {
    if (asked_) following_.follow(motion.start(), kTests, certificates_);
    asked_ = true;
    local_.update(motion);
    certificates_.start(local_);
    for (std::size_t p = 0; p < cut_.tree.patches.size(); ++p)
      certificates_.classify(p, load(local_.records(), cut_.tree.patches[p].vertex));
    certificates_.finish();
  }
  void forget() {
    following_.forget(certificates_);
    asked_ = false;
  }
  std::size_t clusters() const { return cut_.covers[0].observers.size(); }
  std::uint64_t uncertain() const { return certificates_.counts().uncertain; }
  std::uint64_t positive() const { return certificates_.counts().positive; }

  // The pairs of triangles that certificates drop.
  std::set<std::pair<TriangleId, TriangleId>> dropped() const {
    std::set<std::pair<TriangleId, TriangleId>> pairs;
    const PatchTree& tree = cut_.tree;
    for (std::size_t p = 0; p < tree.patches.size(); ++p)
      for (std::size_t q = 0; q < tree.patches.size(); ++q)
        for (std::size_t i = 0; i < tree.triangles_of(p).size(); ++i) {
          const bool all = certificates_.skip(static_cast<std::size_t>(tree.leaf[p]),
                                              static_cast<std::size_t>(tree.leaf[q]));
          const Mask16 needed = all ? Mask16{0} : certificates_.shared(p, q).needed(i);
          for (std::size_t j = 0; j < tree.triangles_of(q).size(); ++j)
            if (const TriangleId a = tree.triangles[p][i], b = tree.triangles[q][j];
                a < b && (needed >> j & 1) == 0)
              pairs.emplace(a, b);
        }
    return pairs;
  }
  // Patches, triangles and clusters name each other, and labels drop nothing between two clusters.
  void expect_partition() const {
    const PatchTree& tree = cut_.tree;
    for (std::size_t p = 0; p < tree.patches.size(); ++p)
      for (std::size_t q = 0; q < tree.patches.size(); ++q)
        if (certificates_.skip(static_cast<std::size_t>(tree.leaf[p]),
                               static_cast<std::size_t>(tree.leaf[q]))) {
          ASSERT_TRUE(share_a_cluster(tree.patches[p], tree.patches[q])) << p << ", " << q;
        }
    for (std::size_t p = 0; p < cut_.tree.patches.size(); ++p) {
      const std::int32_t cluster = cut_.tree.patches[p].cluster[0];
      ASSERT_GE(cluster, 0);
      ASSERT_LT(static_cast<std::size_t>(cluster), clusters());
      for (const TriangleId t : cut_.tree.triangles_of(p)) ASSERT_EQ(cut_.covers[0].cluster_of[+t], cluster);
    }
  }

 private:
  static bool share_a_cluster(const Patch& p, const Patch& q) {
    for (std::size_t c = 0; c < kCovers; ++c)
      if (p.cluster[c] == q.cluster[c] && p.cluster[c] != kNone) return true;
    return false;
  }
  static constexpr std::uint64_t kTests =
      200'000;  // that a descent might have made: leave to cut a few clusters

  std::vector<CappedClusters> capped(std::span<const Vec3> reference) const {
    std::vector<CappedClusters> all;
    for (std::size_t c = 0; c < kCovers; ++c) all.emplace_back(mesh_, reference, cut_.covers[c], c);
    return all;
  }

  const TriangleMesh& mesh_;
  CutSurface cut_;
  LocalPositions local_;
  Certificates certificates_;
  AdaptiveCover following_;
  bool asked_ = false;
};

// A square sheet, whose far half is turned over the near one by `turn` half turns.
std::vector<Vec3> folded(std::vector<Vec3> flat, double turn) {
  for (Vec3& p : flat) {
    const double radius = 0.1, along = std::clamp((p.x() - 0.5) / (3 * radius), 0.0, 1.0);
    const double angle = 3.1 * turn * along, rest = std::max(0.0, p.x() - 0.5 - 3 * radius);
    if (p.x() <= 0.5 || turn <= 0) continue;
    const double bend = 3 * radius / (3.1 * turn);
    p = {0.5 + bend * std::sin(angle) + rest * std::cos(angle), p.y(),
         bend * (1 - std::cos(angle)) + rest * std::sin(angle)};
  }
  return flat;
}

// Mutations: count_uncertified() counts nothing; join_halves() joins nothing.
TEST(AdaptiveCover, HalvesASheetThatIsFoldedAndJoinsItAgain) {
  const test::Shape flat = test::sheet(40);
  const TriangleMesh mesh = flat.mesh();
  Interval interval(mesh, flat.positions, true);
  const std::vector<Vec3> over = folded(flat.positions, 1);
  interval.ask(Motion(flat.positions, flat.positions));
  ASSERT_EQ(interval.clusters(), 1u);
  ASSERT_EQ(interval.uncertain(), 0u);

  interval.ask(Motion(over, over));
  const std::uint64_t uncertain = interval.uncertain();
  EXPECT_GT(uncertain, mesh.triangle_count() / 4);
  for (int k = 0; k < 12; ++k) {
    interval.ask(Motion(over, over));
    interval.expect_partition();
  }
  EXPECT_GT(interval.clusters(), 1u);
  EXPECT_LT(interval.uncertain(), uncertain / 2);

  for (int k = 0; k < 100; ++k) {
    interval.ask(Motion(flat.positions, flat.positions));
    interval.expect_partition();
  }
  EXPECT_EQ(interval.clusters(), 1u);
  EXPECT_EQ(interval.uncertain(), 0u);
}

// Mutations: forget() leaves the observers or the caps as they are.
TEST(AdaptiveCover, AnswersLikeANewOneOnceItHasForgotten) {
  const test::Shape flat = test::sheet(30);
  const TriangleMesh mesh = flat.mesh();
  Interval used(mesh, flat.positions, true), fresh(mesh, flat.positions, true);
  const std::vector<Vec3> half = folded(flat.positions, 0.7), over = folded(flat.positions, 1);
  for (int k = 0; k < 9; ++k) used.ask(Motion(half, over));
  ASSERT_GT(used.clusters(), 1u);
  used.forget();
  EXPECT_EQ(used.clusters(), 1u);
  for (int k = 0; k < 9; ++k) {
    used.ask(Motion(k < 3 ? flat.positions : half, over));
    fresh.ask(Motion(k < 3 ? flat.positions : half, over));
    EXPECT_EQ(used.clusters(), fresh.clusters()) << k;
    EXPECT_EQ(used.positive(), fresh.positive()) << k;
    EXPECT_EQ(used.dropped(), fresh.dropped()) << k;
  }
}

// A sheet is crumpled by random waves until it touches itself, in an order that jumps forwards and backwards.
TEST(AdaptiveCover, DropsNoPairThatTouchesInAnyOrderOfIntervals) {
  const test::Shape flat = test::sheet(20);
  const TriangleMesh mesh = flat.mesh();
  std::size_t touched = 0, most = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937 random(seed);
    const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    std::vector<std::vector<Vec3>> poses = {flat.positions};
    for (int k = 1; k < 6; ++k) {
      poses.push_back(folded(flat.positions, 0.2 * k));
      for (Vec3& p : poses.back()) p += 0.02 * k * Vec3(dice(), dice(), dice());
    }
    Interval interval(mesh, flat.positions, true);
    for (int visit = 0; visit < 10; ++visit) {
      const Motion motion(poses[random() % poses.size()], poses[random() % poses.size()]);
      interval.ask(motion);
      most = std::max(most, interval.clusters());
      const auto dropped = interval.dropped();
      for (const auto& [a, b] : test::touching(mesh, motion)) {
        ++touched;
        EXPECT_FALSE(dropped.contains({a, b}))
            << "seed " << seed << ", visit " << visit << ": " << +a << ", " << +b;
      }
    }
  }
  EXPECT_GT(touched, 1000u);
  EXPECT_GT(most, 1u);
}

}  // namespace
}  // namespace cscd::fast
