#include "core/session/patch_motions.h"

#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>

#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using Pairs = std::set<std::pair<TriangleId, TriangleId>>;

class Kept : public TrianglePairSink {
 public:
  Pairs pairs;

 private:
  void take(const std::vector<TrianglePair>& block) override {
    for (const auto& [a, b] : block) pairs.insert(std::minmax(a, b));
  }
};

fast::PatchTree cut(const TriangleMesh& mesh, const std::vector<Vec3>& pose) {
  const std::vector<std::int32_t> one_cluster(mesh.triangle_count(), 0);
  return fast::make_tree(mesh, pose, fast::cut_into_patches(mesh, pose, {one_cluster, one_cluster}, 1),
                         one_cluster);
}

// All pairs within a reach, from all there are.
std::vector<NearPair> all_near(const TriangleMesh& mesh, const std::vector<Vec3>& pose, double reach) {
  std::vector<NearPair> out;
  NearCollector collector(mesh, pose, mesh.triangle_count() * mesh.triangle_count(), reach, out);
  std::vector<Eigen::AlignedBox3d> box(mesh.triangle_count());
  for (std::size_t t = 0; t < box.size(); ++t)
    for (const VertexId v : mesh.triangles()[t]) box[t].extend(pose[+v]);
  for (std::size_t a = 0; a < box.size(); ++a)
    for (std::size_t b = a + 1; b < box.size(); ++b)
      if (box[a].exteriorDistance(box[b]) < 1.001 * reach)
        collector.add(TriangleId{static_cast<std::int32_t>(a)}, TriangleId{static_cast<std::int32_t>(b)});
  collector.flush();
  return out;
}
// Two sheets, one above the other, and a ball above both.
class PatchMotionsTest : public testing::Test {
 protected:
  static constexpr int kCells = 16;
  static constexpr double kCell = 2.0 / kCells;
  static constexpr std::size_t kOfSheet = (kCells + 1) * (kCells + 1);

  PatchMotionsTest()
      : shape_(test::together(
            test::together(test::sheet(kCells), test::moved(test::sheet(kCells), {0.01, 0.02, kGap})),
            test::moved(test::icosphere(2), {0.2, 0.1, 2 * kGap + 0.5}, 0.5))),
        mesh_(shape_.mesh()),
        motions_(shape_.positions, cut(mesh_, shape_.positions)) {}

  double draw() { return some_(random_); }
  Vec3 draw_point() { return {draw(), draw(), draw()}; }

  std::vector<NearPair> near(const std::vector<Vec3>& pose, double reach) const {
    return all_near(mesh_, pose, reach);
  }
  void anchor(const std::vector<Vec3>& pose, double reach) {
    motions_.set_anchor(pose, reach, near(pose, reach));
  }

  // Holds what is passed on to what is near. Returns how many pairs were passed on.
  std::size_t expect_all(const std::vector<Vec3>& pose, double reach) {
    constexpr std::size_t kAny = ~std::size_t{0};
    Kept kept;
    std::vector<NearPair> known;
    bent_ = motions_.pass_on(pose, reach, kAny, known, kept);
    if (!bent_) return 0;
    std::map<std::pair<TriangleId, TriangleId>, double> low_of;
    for (const auto& [low, pair] : known) {
      kept.pairs.insert(std::minmax(pair.a, pair.b));
      low_of[std::minmax(pair.a, pair.b)] = low;
    }
    for (const auto& [low, pair] : near(pose, reach * (1 - 1e-9))) {
      if (const auto known_low = low_of.find(std::minmax(pair.a, pair.b)); known_low != low_of.end()) {
        EXPECT_LE(known_low->second, low + 1e-12);
      }
      EXPECT_TRUE(kept.pairs.contains(std::minmax(pair.a, pair.b)))
          << "triangles " << +pair.a << " and " << +pair.b << ", " << low << " apart";
    }
    return kept.pairs.size();
  }

  static constexpr double kGap = 0.5 * kCell;
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> some_{-1, 1};
  test::Shape shape_;
  TriangleMesh mesh_;
  PatchMotions motions_;
  std::optional<std::size_t> bent_;
};

// Without an anchor, nothing is known of what is near.
TEST_F(PatchMotionsTest, NeedAnAnchor) {
  EXPECT_FALSE(motions_.has_anchor());
  expect_all(shape_.positions, 0.5 * kCell);
  EXPECT_FALSE(bent_);
  anchor(shape_.positions, 0.6 * kCell);
  EXPECT_TRUE(motions_.has_anchor());
  motions_.forget_anchor();
  EXPECT_FALSE(motions_.has_anchor());
}

// A pose that is turned and shifted as a whole keeps all distances, so that no pair is looked at anew.
TEST_F(PatchMotionsTest, KnowWhatIsNearWhereAllTurns) {
  anchor(shape_.positions, 0.6 * kCell);
  const std::size_t listed = near(shape_.positions, 0.55 * kCell).size();
  ASSERT_GT(listed, 100u);
  std::vector<Vec3> pose = shape_.positions;
  for (int n = 0; n < 20; ++n) {
    const Eigen::AngleAxisd turn(0.5 * draw(), draw_point().normalized());
    const Vec3 shift = draw_point();
    for (Vec3& p : pose) p = turn * p + shift;
    const std::size_t passed = expect_all(pose, 0.55 * kCell);
    ASSERT_EQ(bent_, 0u) << n;
    EXPECT_GE(passed, listed);
    EXPECT_LE(passed, near(pose, 0.56 * kCell).size());
  }
}

// Pieces that turn on their own, sheets that roll up, and vertices that leave their places: towards each
// other by as much as the room between both reaches allows, a little less and a little more.
TEST_F(PatchMotionsTest, LoseNoNearPair) {
  std::size_t without_bent = 0, with_bent = 0;
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    std::vector<Vec3> start = shape_.positions;
    for (Vec3& p : start) p += 0.02 * kCell * draw_point();
    // Every tenth time, next to nothing moves, and what is known of both sheets is near.
    const bool is_small = n % 10 == 9;
    const double far = kGap * (is_small ? 1.2 : 0.9 + 0.15 * draw()),
                 reach = far * (is_small ? 0.95 : 0.5 + 0.3 * draw());
    anchor(start, far);
    const double size = (far - reach) * (is_small ? 0.1 : 0.6 + 0.6 * draw());
    const double of_lower = n % 3 == 0 ? 0 : size, of_upper = n % 3 == 1 ? 0 : size;
    const bool smooth = n % 2 == 0;
    std::vector<Vec3> pose = start;
    Eigen::AngleAxisd whole(0, Vec3::UnitX());
    for (int step = 0; step < 4; ++step) {
      for (std::size_t v = 0; v < 2 * kOfSheet; ++v) {
        const double most = v < kOfSheet ? of_lower : -of_upper;
        const double wave = std::cos(9 * start[v].x() + step) * std::cos(7 * start[v].y());
        pose[v] = start[v] + Vec3(0, 0, most * (smooth ? wave * wave : std::abs(draw())));
      }
      // The ball turns by itself and sinks; both sheets roll up more and more.
      const Eigen::AngleAxisd own(0.3 * step, Vec3(1, 2, 3).normalized());
      for (std::size_t v = 2 * kOfSheet; v < pose.size(); ++v)
        pose[v] = own * start[v] - Vec3(0, 0, 0.02 * step * step);
      const double curvature = n % 5 == 4 ? 0.4 * step : 0.05 * step;
      if (curvature > 0)
        for (Vec3& p : pose) {
          const double radius = 1 / curvature - p.z(), angle = curvature * p.x();
          p = {radius * std::sin(angle), p.y(), 1 / curvature - radius * std::cos(angle)};
        }
      whole = Eigen::AngleAxisd(0.4 * step, Vec3(3, -1, 2).normalized());
      for (Vec3& p : pose) p = whole * p;
      expect_all(pose, reach);
      ASSERT_TRUE(bent_);
      (*bent_ == 0 ? without_bent : with_bent) += 1;
    }
  }
  EXPECT_GT(without_bent, 10u);
  EXPECT_GT(with_bent, 50u);
}

// Vertices of one patch that come near each other: to and fro across the diagonals of a single sheet, where
// triangles that share a vertex are 0.7 cells apart.
TEST(PatchMotions, SeesAPatchCrumple) {
  constexpr int kCells = 16;
  const test::Shape shape = test::sheet(kCells);
  const TriangleMesh mesh = shape.mesh();
  PatchMotions motions(shape.positions, cut(mesh, shape.positions));
  const double far = 0.68 * 2 / kCells, reach = 0.38 * 2 / kCells;
  std::vector<NearPair> known = all_near(mesh, shape.positions, far);
  ASSERT_TRUE(known.empty());
  motions.set_anchor(shape.positions, far, known);
  std::mt19937 random(3);
  for (int n = 0; n < 20; ++n) {
    std::vector<Vec3> pose = shape.positions;
    for (Vec3& p : pose) p += (random() % 2 == 0 ? 0.8 : -0.8) * (far - reach) * Vec3(1, -1, 0).normalized();
    Kept kept;
    ASSERT_TRUE(motions.pass_on(pose, reach, ~std::size_t{0}, known, kept));
    const std::vector<NearPair> near = all_near(mesh, pose, reach * (1 - 1e-9));
    EXPECT_FALSE(near.empty());
    for (const auto& [low, pair] : near) EXPECT_TRUE(kept.pairs.contains(std::minmax(pair.a, pair.b)));
  }
}

// Each half of a sheet keeps its shape while it is folded onto the other.
TEST_F(PatchMotionsTest, SeeAFold) {
  anchor(shape_.positions, 0.4 * kCell);
  for (int n = 0; n < 20; ++n) {
    SCOPED_TRACE(n);
    const Vec3 way = Vec3(draw(), draw(), 0).normalized();
    const double at = 0.7 * draw();
    for (int step = 1; step <= 8; ++step) {
      std::vector<Vec3> pose = shape_.positions;
      const Eigen::AngleAxisd fold(step * 0.39, Vec3(0, 0, 1).cross(way));
      for (Vec3& p : pose)
        if (way.dot(p) > at) p = at * way + fold * (p - at * way);
      expect_all(pose, 0.3 * kCell);
      EXPECT_GT(*bent_, 0u);
    }
  }
}

TEST_F(PatchMotionsTest, GiveUpWhereTooMuchIsBent) {
  std::vector<Vec3> pose = shape_.positions;
  std::vector<NearPair> known;
  Kept kept;
  EXPECT_FALSE(motions_.pass_on(pose, 0.1 * kCell, 1000, known, kept)) << "without an anchor";
  anchor(pose, 0.4 * kCell);
  EXPECT_FALSE(motions_.pass_on(pose, 0.4 * kCell, 1000, known, kept)) << "reaches as far as the anchor";
  EXPECT_EQ(motions_.pass_on(pose, 0.1 * kCell, 1000, known, kept), 0u);
  for (Vec3& p : pose) p += 0.3 * kCell * draw_point();
  EXPECT_FALSE(motions_.pass_on(pose, 0.3 * kCell, 1000, known, kept));
  EXPECT_GT(motions_.pass_on(pose, 0.3 * kCell, 1'000'000, known, kept), 1000u);
  motions_.forget_anchor();
  EXPECT_FALSE(motions_.pass_on(pose, 0.1 * kCell, 1000, known, kept));
}

}  // namespace
}  // namespace cscd
