#include "core/fast/prepare/carried_cut.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "core/fast/prepare/cluster_observer.h"
#include "core/fast/prepare/saved_cut.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

// A body that was cut and saved.
struct Kept : test::Body {
  Kept() : test::Body(0.01, 0) {}
  std::vector<std::byte> bytes() const {
    return saved_cut(mesh, shape.positions, cut_surface(mesh, shape.positions, atomic.of_triangle), 2);
  }
};

RestoredCut taken_over(const test::Shape& changed, std::span<const std::byte> bytes) {
  RestoredCut restored = restored_cut(changed.mesh(), changed.positions, bytes);
  EXPECT_EQ(restored.covers, 2u);
  return restored;
}

std::size_t cluster_count(const CutSurface& cut) {
  std::size_t count = 0;
  for (const Cover& cover : cut.covers) count += cover.observers.size();
  return count;
}

// Divides some triangles into three at their middles.
test::Shape refined(test::Shape shape, std::span<const std::size_t> triangles) {
  for (const std::size_t t : triangles) {
    const Triangle c = shape.triangles[t];
    const int middle = static_cast<int>(shape.positions.size());
    shape.positions.push_back((shape.positions[+c[0]] + shape.positions[+c[1]] + shape.positions[+c[2]]) / 3);
    shape.triangles[t][2] = VertexId{middle};
    shape.triangles.push_back({c[1], c[2], VertexId{middle}});
    shape.triangles.push_back({c[2], c[0], VertexId{middle}});
  }
  return shape;
}

// Mutations: the corner that comes first is kept in the digest; an observer follows vertices by their old
// numbers.
TEST(CarriedCut, KnowsTheSurfaceAgainHoweverItIsNumbered) {
  const Kept kept;
  const CutSurface before = cut_surface(kept.mesh, kept.shape.positions, kept.atomic.of_triangle);
  std::vector<std::size_t> vertex(kept.shape.positions.size());
  std::iota(vertex.begin(), vertex.end(), std::size_t{0});
  std::mt19937 random(5);
  std::ranges::shuffle(vertex, random);
  test::Shape shuffled = kept.shape;
  for (std::size_t v = 0; v < vertex.size(); ++v) shuffled.positions[vertex[v]] = kept.shape.positions[v];
  for (Triangle& c : shuffled.triangles) {
    for (VertexId& v : c) v = VertexId{static_cast<std::int32_t>(vertex[+v])};
    std::rotate(c.begin(), c.begin() + random() % 3, c.end());
  }
  std::ranges::shuffle(shuffled.triangles, random);
  const RestoredCut now = taken_over(shuffled, kept.bytes());
  EXPECT_EQ(now.new_triangles, 0u);
  EXPECT_EQ(now.cut.tree.patches.size(), before.tree.patches.size());
  std::vector<Vec3> stands, stood;
  for (std::size_t c = 0; c < kCovers; ++c) {
    for (const FollowingPoint& o : now.cut.covers[c].observers) stands.push_back(o.at(shuffled.positions));
    for (const FollowingPoint& o : before.covers[c].observers) stood.push_back(o.at(kept.shape.positions));
  }
  const auto ascending = [](const Vec3& a, const Vec3& b) {
    return std::ranges::lexicographical_compare(std::span(a.data(), 3), std::span(b.data(), 3));
  };
  std::ranges::sort(stands, ascending);
  std::ranges::sort(stood, ascending);
  EXPECT_EQ(stands, stood);
}

// Mutations: everything is cut anew; new triangles get no cluster of the further covers.
TEST(CarriedCut, CutsOnlyWhereTheSurfaceHasChanged) {
  const Kept kept;
  const CutSurface before = cut_surface(kept.mesh, kept.shape.positions, kept.atomic.of_triangle);
  const std::size_t changed[] = {100, 101, 102, 700, 1500};
  const test::Shape shape = refined(kept.shape, changed);
  const RestoredCut now = taken_over(shape, kept.bytes());
  EXPECT_EQ(now.new_triangles, 3 * std::size(changed));
  EXPECT_EQ(cluster_count(now.cut), cluster_count(before));
  EXPECT_LE(now.cut.tree.patches.size(), before.tree.patches.size() + 2 * std::size(changed));
  std::vector<std::vector<TriangleId>> was, is;
  for (std::size_t p = 0; p < before.tree.patches.size(); ++p) {
    const auto t = before.tree.triangles_of(p);
    was.emplace_back(t.begin(), t.end());
  }
  for (std::size_t p = 0; p < now.cut.tree.patches.size(); ++p) {
    const auto t = now.cut.tree.triangles_of(p);
    is.emplace_back(t.begin(), t.end());
  }
  std::size_t lost = 0;
  for (const auto& patch : was) lost += std::ranges::find(is, patch) == is.end();
  EXPECT_GE(lost, 3u);
  EXPECT_LE(lost, std::size(changed));
  const auto share_in = [](const CutSurface& cut, std::size_t c) {
    const auto& of = cut.covers[c].cluster_of;
    return static_cast<double>(std::ranges::count_if(of, [](std::int32_t i) { return i != kNone; })) /
           static_cast<double>(of.size());
  };
  for (std::size_t c = 0; c < kCovers; ++c)
    EXPECT_NEAR(share_in(now.cut, c), share_in(before, c), 0.003) << "cover " << c;
}

// Mutation: observers are never looked for again.
TEST(CarriedCut, LooksForAnotherObserverWhereMuchIsNew) {
  const Kept kept;
  const CutSurface before = cut_surface(kept.mesh, kept.shape.positions, kept.atomic.of_triangle);
  test::Shape shape = kept.shape;
  for (std::size_t v = 0; v < 15 * 12; ++v) shape.positions[v].y() *= 1.5;
  const RestoredCut now = taken_over(shape, kept.bytes());
  const TriangleMesh mesh = shape.mesh();
  std::size_t again = 0;
  for (std::size_t c = 0; c < now.cut.covers[0].observers.size(); ++c) {
    std::vector<TriangleId> members;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      if (now.cut.covers[0].cluster_of[t] == static_cast<std::int32_t>(c))
        members.push_back(TriangleId{static_cast<std::int32_t>(t)});
    again += now.cut.covers[0].observers[c].at(shape.positions) ==
             observer_of(mesh, shape.positions, members).at(shape.positions);
  }
  EXPECT_EQ(again, before.covers[0].observers.size()) << "those of whole clusters are what they would be";
}

// A component of its own needs a cluster of its own (rule component, core/soundness.md). Mutation: clusters
// are not divided.
TEST(CarriedCut, DividesAClusterThatIsCutInTwo) {
  const Kept kept;
  test::Shape shape = kept.shape;
  // The first half of a tube loses its vertices to the second along one circle.
  const auto copies = static_cast<int>(shape.positions.size());
  constexpr int kSides = 12, kCircle = 30 * kSides;
  for (int j = 0; j < kSides; ++j) shape.positions.push_back(shape.positions[kCircle + j]);
  for (Triangle& c : shape.triangles) {
    const double x = (shape.positions[+c[0]].x() + shape.positions[+c[1]].x() + shape.positions[+c[2]].x());
    if (x / 3 < shape.positions[kCircle].x()) continue;
    for (VertexId& v : c)
      if (+v >= kCircle && +v < kCircle + kSides) v = VertexId{copies + static_cast<int>(v) - kCircle};
  }
  const TriangleMesh mesh = shape.mesh();
  ASSERT_EQ(mesh.component_count(), 2);
  const RestoredCut now = taken_over(shape, kept.bytes());
  EXPECT_EQ(now.new_triangles, 0u) << "no triangle has moved";
  const CutSurface before = cut_surface(kept.mesh, kept.shape.positions, kept.atomic.of_triangle);
  EXPECT_GT(cluster_count(now.cut), cluster_count(before));
}

// The surface stays in one piece, but triangles of one patch no longer share vertices. Mutation: such a patch
// is taken over, and the preparation is then refused for want of room in it.
TEST(CarriedCut, CutsPatchesAnewThatASlitRunsThrough) {
  constexpr int kCells = 20, kRow = 9, kAcross = kCells + 1;
  test::Shape shape = test::sheet(kCells);
  const TriangleMesh whole = shape.mesh();
  const std::vector<std::byte> bytes =
      saved_cut(whole, shape.positions,
                cut_surface(whole, shape.positions, std::vector<std::int32_t>(whole.triangle_count(), 0)), 2);
  const auto copies = static_cast<int>(shape.positions.size());
  const auto row_of = [&](VertexId v) { return static_cast<int>(v) / kAcross; };
  for (int j = 0; j < kCells / 2; ++j) shape.positions.push_back(shape.positions[kRow * kAcross + j]);
  for (Triangle& c : shape.triangles)
    if (std::ranges::any_of(c, [&](VertexId v) { return row_of(v) == kRow + 1; }))
      for (VertexId& v : c)
        if (const int j = static_cast<int>(v) % kAcross; row_of(v) == kRow && j < kCells / 2)
          v = VertexId{copies + j};
  ASSERT_EQ(shape.mesh().component_count(), 1);
  EXPECT_EQ(taken_over(shape, bytes).new_triangles, 0u) << "no triangle has moved";
}

// Mutation: a new component is one cluster, or none.
TEST(CarriedCut, CutsANewComponentIntoClusters) {
  const Kept kept;
  const test::Shape ball = test::moved(test::icosphere(3), {40, 0, 0});
  const test::Shape tube = test::moved(test::capped_tube(8, 40, 0.5, 20), {0, 9, 0});
  const CutSurface before = cut_surface(kept.mesh, kept.shape.positions, kept.atomic.of_triangle);
  const RestoredCut with_ball = taken_over(test::together(kept.shape, ball), kept.bytes());
  EXPECT_EQ(with_ball.new_triangles, ball.triangles.size());
  EXPECT_GT(with_ball.cut.covers[0].observers.size(), before.covers[0].observers.size());
  const RestoredCut with_tube = taken_over(test::together(kept.shape, tube), kept.bytes());
  EXPECT_GT(with_tube.cut.covers[0].observers.size(), with_ball.cut.covers[0].observers.size())
      << "one observer does not see a long tube";
}

// Mutations: a triangle that lies twice in one place is told from the other; one is taken over twice.
TEST(CarriedCut, TakesWhatLiesTwiceInOnePlaceAsNew) {
  const Kept kept;
  const test::Shape twice = test::together(kept.shape, kept.shape);
  EXPECT_EQ(taken_over(twice, kept.bytes()).new_triangles, kept.shape.triangles.size());
  const TriangleMesh mesh = twice.mesh();
  std::vector<std::int32_t> components;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    components.push_back(mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
  const std::vector<std::byte> both =
      saved_cut(mesh, twice.positions, cut_surface(mesh, twice.positions, components), 2);
  EXPECT_THROW(taken_over(kept.shape, both), InputError) << "nothing of it is known again";
}

TEST(CarriedCut, TheCutOfAnotherSurfaceIsRefused) {
  const Kept kept;
  test::Shape moved = kept.shape;
  for (Vec3& p : moved.positions) p.x() += 1;
  EXPECT_EQ(test::refusal([&] { taken_over(moved, kept.bytes()); }),
            "preparation: was made for another surface; prepare anew without it");
  // Less than half of it.
  moved = kept.shape;
  for (std::size_t v = 0; v < moved.positions.size() * 6 / 10; ++v) moved.positions[v].x() += 1e-12;
  EXPECT_THROW(taken_over(moved, kept.bytes()), InputError);
}

}  // namespace
}  // namespace cscd::fast
