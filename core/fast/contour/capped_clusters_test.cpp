#include "core/fast/contour/capped_clusters.h"

#include <gtest/gtest.h>
#include <map>

#include "core/fast/contour/test_touching.h"
#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

using test::Shape;
using test::touching;

// Runs the contour test of one cover for one interval, and holds which triangles are clear.
class Seen {
 public:
  Seen(const TriangleMesh& mesh, std::span<const Vec3> reference, const PatchTree& tree, const Cover& cover,
       std::size_t number, const Motion& motion)
      : cover_(cover), local_(reference), clear_(mesh.triangle_count()) {
    local_.update(motion);
    std::vector<Viewpoint> from;
    for (const FollowingPoint& observer : cover.observers) from.push_back(placed(observer, local_.records()));
    CappedClusters capped(mesh, reference, cover, number);
    capped.start(local_, from);
    const auto for_each = [&](const auto& take) {
      for (std::size_t p = 0; p < tree.patches.size(); ++p) {
        const Patch& patch = tree.patches[p];
        if (patch.cluster[number] == kNone) continue;
        const PatchLanes lanes = load(local_.records(), patch.vertex);
        const Viewpoint& viewpoint = from[static_cast<std::size_t>(patch.cluster[number])];
        take(
            p, lanes,
            static_cast<Mask16>(orientation(lanes, patch, viewpoint, local_.error()).positive & patch.lanes));
      }
    };
    for_each([&](std::size_t p, const PatchLanes& lanes, Mask16 positive) {
      const Patch& patch = tree.patches[p];
      if (positive != patch.lanes ||
          capped.may_cross_ray(static_cast<std::size_t>(patch.cluster[number]), lanes))
        capped.take(patch, positive);
    });
    while (capped.choose_other_rays()) {
      ++other_rays_;
      for_each([&](std::size_t p, const PatchLanes&, Mask16 positive) {
        const Patch& patch = tree.patches[p];
        if (capped.has_other_ray(static_cast<std::size_t>(patch.cluster[number])))
          capped.count(patch, positive);
      });
    }
    for_each([&](std::size_t p, const PatchLanes&, Mask16 positive) {
      const Mask16 clear = capped.clear(tree.patches[p], positive);
      EXPECT_EQ(clear & ~positive, 0);
      const std::span<const TriangleId> triangles = tree.triangles_of(p);
      for (std::size_t l = 0; l < triangles.size(); ++l) clear_[+triangles[l]] = (clear >> l & 1) != 0;
    });
  }
  bool dropped(TriangleId a, TriangleId b) const {
    return cover_.cluster_of[+a] == cover_.cluster_of[+b] && cover_.cluster_of[+a] != kNone &&
           (clear_[+a] || clear_[+b]);
  }
  std::size_t other_rays() const { return other_rays_; }
  std::size_t clear() const {
    return static_cast<std::size_t>(std::count(clear_.begin(), clear_.end(), true));
  }

 private:
  const Cover& cover_;
  LocalPositions local_;
  std::vector<bool> clear_;
  std::size_t other_rays_ = 0;
};

// An open surface that is one cluster. Its observer follows a vertex that no triangle uses.
struct OneCluster {
  Shape shape;
  TriangleMesh mesh;
  CutSurface cut;

  OneCluster(Shape surface, const Vec3& from)
      : shape(with_vertex(std::move(surface), from)),
        mesh(shape.mesh()),
        cut(cut_surface(mesh, shape.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0))) {
    cut.covers[0].observers = {FollowingPoint()};
    cut.covers[0].observers[0].add(VertexId{static_cast<std::int32_t>(shape.positions.size()) - 1}, 1);
  }
  Seen seen(const Motion& motion) const {
    return {mesh, shape.positions, cut.tree, cut.covers[0], 0, motion};
  }

 private:
  static Shape with_vertex(Shape shape, const Vec3& at) {
    shape.positions.push_back(at);
    return shape;
  }
};

// A strip that winds like a spiral staircase faces its observer all along, and covers some directions twice.
// The ray goes where the strip covers directions once. Mutation: caps are ignored.
TEST(CappedClusters, AnOpenSpiralThatIsSqueezedIsNotClear) {
  for (const double turns : {0.2, 1.25, 1.75}) {
    const OneCluster ramp(test::ramp(24, turns, 1, 2, 1), {-1.2, -0.5, -2});
    std::vector<Vec3> end = ramp.shape.positions;
    for (std::size_t i = 0; i + 1 < end.size(); ++i)
      end[i].z() = 0.02 * end[i].z() + 0.01 * turns * static_cast<double>(i % 5);
    const Motion motion(ramp.shape.positions, end);
    const Seen seen = ramp.seen(motion);
    const auto pairs = touching(ramp.mesh, motion);
    EXPECT_EQ(pairs.empty(), turns < 1);
    if (turns < 1) {
      EXPECT_GT(seen.clear(), ramp.mesh.triangle_count() / 2);
    }
    for (const auto& [a, b] : pairs) EXPECT_FALSE(seen.dropped(a, b)) << turns << ": " << +a << ", " << +b;
  }
}

// The same strip sinks onto itself from a start that is embedded. Nothing is ever seen from in front, so a
// rule about signs would drop every pair, the first contact too.
TEST(CappedClusters, SignsAloneLoseTheFirstContactOfAnOpenSpiral) {
  const OneCluster ramp(test::ramp(24, 1.75, 1, 2, 1), {-1.2, -0.5, -2});
  std::vector<Vec3> end = ramp.shape.positions;
  for (std::size_t i = 0; i + 1 < end.size(); ++i)
    end[i].z() = 0.02 * end[i].z() + 0.0175 * static_cast<double>(i % 5);
  const Motion motion(ramp.shape.positions, end);
  EXPECT_TRUE(touching(ramp.mesh, Motion(ramp.shape.positions, ramp.shape.positions)).empty());
  EXPECT_FALSE(touching(ramp.mesh, motion).empty());
  LocalPositions local(ramp.shape.positions);
  local.update(motion);
  const Viewpoint from = placed(ramp.cut.covers[0].observers[0], local.records());
  for (const Patch& patch : ramp.cut.tree.patches)
    EXPECT_EQ(
        orientation(load(local.records(), patch.vertex), patch, from, local.error()).positive & patch.lanes,
        patch.lanes);
}

// A disc with a notch. Its two lobes on both sides of the notch lean over each other, and one sinks through
// the other. All triangles are positive, and only the cap, which turns back along the sides of the notch,
// says that some directions are covered twice. Mutations: triangles of a cap that are not positive
// get no cone, or one about the slice next to the apex alone.
TEST(CappedClusters, LobesThatLeanOverEachOtherAreNotClear) {
  constexpr int kRings = 8, kSectors = 72;
  // Where a vertex is when the lobes lean by so many radians at the rim, and one is so much higher.
  const auto place = [](int ring, int sector, double lean, double height) {
    const double angle = 2 * std::numbers::pi * sector / kSectors, off = angle - std::numbers::pi;
    const double degrees = std::abs(off) * 180 / std::numbers::pi;
    const double radius = std::clamp(0.45 + 0.55 * (degrees - 10) / 20, 0.45, 1.0) * ring / kRings;
    const double bend = 2 * std::max(0.0, radius - 0.5) * std::clamp((90 - degrees) / 60, 0.0, 1.0);
    const double turned = angle - std::copysign(lean * bend, off);
    return Vec3(radius * std::cos(turned), radius * std::sin(turned), off < 0 ? height * bend : 0.0);
  };
  const auto disc = [&](double lean, double height) {
    std::vector<Vec3> positions = {Vec3::Zero()};
    for (int ring = 1; ring <= kRings; ++ring)
      for (int sector = 0; sector < kSectors; ++sector)
        positions.push_back(place(ring, sector, lean, height));
    return positions;
  };
  Shape flat{disc(0, 0), {}};
  const auto at = [](int ring, int sector) {
    return ring == 0 ? 0 : 1 + (ring - 1) * kSectors + sector % kSectors;
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      if (ring > 0)
        flat.triangles.push_back(test::corners(at(ring, sector), at(ring + 1, sector), at(ring, sector + 1)));
      flat.triangles.push_back(
          test::corners(at(ring, sector + 1), at(ring + 1, sector), at(ring + 1, sector + 1)));
    }
  const Vec3 from(0.01, 0.02, -1);
  const OneCluster cluster(flat, from);
  for (const double lean : {0.0, 0.7}) {
    std::vector<Vec3> start = disc(lean, 0.1), end = disc(lean, -0.1);
    start.push_back(from), end.push_back(from);
    const Motion motion(start, end);
    const Seen seen = cluster.seen(motion);
    const auto pairs = touching(cluster.mesh, motion);
    EXPECT_EQ(pairs.empty(), lean == 0);
    EXPECT_GT(seen.clear(), cluster.mesh.triangle_count() / 2);
    for (const auto& [a, b] : pairs) EXPECT_FALSE(seen.dropped(a, b)) << +a << ", " << +b;
  }
}

// A tube goes round twice before it closes. The tube and its caps face the observer in the middle everywhere.
// Mutation: crossings are not counted.
TEST(CappedClusters, ATubeThatGoesRoundTwiceIsNotClear) {
  for (const int turns : {1, 2}) {
    constexpr int kSteps = 60;
    Shape tube;
    for (int i = 0; i < kSteps; ++i)
      for (int z = -1; z <= 1; ++z) {
        const double angle = 2 * std::numbers::pi * turns * i / kSteps, r = 1 + 0.3 * std::cos(angle / turns);
        tube.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.4 * z);
      }
    for (int i = 0; i < kSteps; ++i)
      for (int z = 0; z < 2; ++z) {
        const int a = 3 * i + z, b = 3 * ((i + 1) % kSteps) + z;
        tube.triangles.push_back(test::corners(a, b, b + 1));
        tube.triangles.push_back(test::corners(a, b + 1, a + 1));
      }
    const OneCluster twice(tube, {0.01, 0.02, 0.03});
    const Motion still(twice.shape.positions, twice.shape.positions);
    const Seen seen = twice.seen(still);
    EXPECT_EQ(touching(twice.mesh, still).empty(), turns == 1);
    EXPECT_EQ(seen.clear(), turns == 1 ? twice.mesh.triangle_count() : 0);
  }
}

// A fold where the first ray goes: some triangles are not positive there. Another ray counts how often the
// sphere goes round the observer. Mutation: another ray is believed without a count.
TEST(CappedClusters, AnotherRayDecidesWhereTheFirstMeetsAFold) {
  const OneCluster sphere(test::icosphere(3), {0.01, 0.02, 0.03});
  const std::vector<Vec3>& round = sphere.shape.positions;
  std::size_t decided = 0;
  for (std::size_t v = 0; v + 1 < round.size(); ++v) {
    const Triangle& some =
        sphere.mesh.corners(sphere.mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)})[0]);
    const Vec3& beside = round[+(+some[0] == v ? some[1] : some[0])];
    std::vector<Vec3> folded = round;
    folded[v] = 1.2 * (round[v] + 2.5 * (beside - round[v]));
    const Seen seen = sphere.seen(Motion(folded, folded));
    if (seen.other_rays() > 0) decided += seen.clear() > sphere.mesh.triangle_count() / 2;
  }
  EXPECT_GT(decided, 0u);
}

// A bent tube whose vertices move at random until the tube touches itself, also from starts that touch
// already. Mutations: clear() returns `positive`; clusters that are not `known` count as known.
TEST(CappedClusters, NoPairThatTouchesIsDropped) {
  std::size_t touching_in_cluster = 0, clear = 0, all = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    const double noise = 0.015 * seed;
    test::Body body(noise, 2, {3, -2, 1}, 1, seed);
    if (seed % 2 == 0) std::swap(body.start, body.end);
    const auto [covers, tree] = cut_surface(body.mesh, body.shape.positions, body.atomic.of_triangle);
    const auto pairs = touching(body.mesh, body.motion());
    for (std::size_t c = 0; c < kCovers; ++c) {
      const Seen seen(body.mesh, body.shape.positions, tree, covers[c], c, body.motion());
      clear += seen.clear();
      all += body.mesh.triangle_count();
      for (const auto& [a, b] : pairs) {
        EXPECT_FALSE(seen.dropped(a, b)) << "seed " << seed << ", cover " << c << ": " << +a << ", " << +b;
        touching_in_cluster +=
            covers[c].cluster_of[+a] == covers[c].cluster_of[+b] && covers[c].cluster_of[+a] != kNone;
      }
    }
  }
  EXPECT_GT(clear, all / 10);
  EXPECT_GT(touching_in_cluster, 800u);
}

// A flat sheet, an observer that stands off it, and a cap beyond the observer: everything is clear, as long
// as the sheet stays open. Once a corner of it is folded over, what it comes down on is not. Mutation: as
// above.
TEST(CappedClusters, ASheetIsClearUntilItIsFoldedOntoItself) {
  const Shape flat = test::sheet(24);
  const TriangleMesh mesh = flat.mesh();
  const CutSurface cut =
      cut_surface(mesh, flat.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0));
  ASSERT_TRUE(cut.covers[0].observers.at(0).stands_off());
  const auto seen = [&](const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
    return Seen(mesh, flat.positions, cut.tree, cut.covers[0], 0, Motion(start, end));
  };
  std::vector<Vec3> waved = flat.positions, folded = flat.positions;
  for (Vec3& p : waved) p += Vec3(0.1, 3, 0.1 * std::sin(4 * p.x()) + 0.1 * p.y());
  EXPECT_EQ(seen(flat.positions, waved).clear(), mesh.triangle_count());
  for (Vec3& p : folded)
    if (const double over = p.x() + p.y() - 1; over > 0) p += Vec3(-over, -over, -0.3 * over * (over - 0.8));
  const Motion folding(flat.positions, folded);
  const Seen over = seen(flat.positions, folded);
  const auto pairs = touching(mesh, folding);
  EXPECT_GT(pairs.size(), 20u);
  EXPECT_GT(over.clear(), mesh.triangle_count() / 4);
  for (const auto& [a, b] : pairs) EXPECT_FALSE(over.dropped(a, b)) << +a << ", " << +b;
}

// The triangles of a cluster and its caps pass every edge as often in one direction as in the other.
// Mutation: a triangle that cuts off a vertex is left out.
TEST(Caps, CloseTheirClusters) {
  const test::Body body(0.1, 2);
  const Covers covers = cut_surface(body.mesh, body.shape.positions, body.atomic.of_triangle).covers;
  std::size_t caps_seen = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    std::map<std::size_t, std::map<std::pair<int, int>, int>> passed;  // by cluster
    const auto pass = [&](std::size_t cluster, const std::array<int, 3>& corner) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = corner[k], to = corner[(k + 1) % 3];
        passed[cluster][std::minmax(from, to)] += from < to ? 1 : -1;
      }
    };
    for (std::size_t t = 0; t < body.mesh.triangle_count(); ++t) {
      if (covers[c].cluster_of[t] == kNone) continue;
      const Triangle& corner = body.mesh.triangles()[t];
      pass(static_cast<std::size_t>(covers[c].cluster_of[t]),
           {static_cast<int>(corner[0]), static_cast<int>(corner[1]), static_cast<int>(corner[2])});
    }
    int apex = 0;
    CapBuilder builder(body.mesh);
    for (std::size_t cluster = 0; cluster < covers[c].observers.size(); ++cluster) {
      std::vector<TriangleId> triangles;
      for (std::size_t t = 0; t < body.mesh.triangle_count(); ++t)
        if (covers[c].cluster_of[t] == static_cast<std::int32_t>(cluster))
          triangles.push_back(TriangleId{static_cast<std::int32_t>(t)});
      for (const Cap& cap : builder.caps_of(triangles, body.shape.positions, covers[c].observers[cluster])) {
        ++caps_seen;
        --apex;
        for (const Patch& fan : cap.fans)
          for (std::size_t l = 0; fan.lanes >> l != 0; ++l) {
            std::array<int, 3> corner;
            for (std::size_t k = 0; k < 3; ++k)
              corner[k] = fan.corner[k][l] == kLanes16 - 1 ? apex : fan.vertex[fan.corner[k][l]];
            pass(cluster, corner);
          }
      }
    }
    for (const auto& [cluster, edges] : passed)
      for (const auto& [edge, times] : edges)
        EXPECT_EQ(times, 0) << cluster << ": " << edge.first << ", " << edge.second;
  }
  EXPECT_GE(caps_seen, 10u);
}

}  // namespace
}  // namespace cscd::fast
