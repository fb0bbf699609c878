#include <gtest/gtest.h>
#include <random>
#include <string>

#include "core/crossing/generic_side.h"
#include "core/crossing/overlaps.h"
#include "core/crossing/self_winding.h"
#include "core/crossing/test_overlaps.h"
#include "core/elementary/exact/static_contact.h"
#include "core/geometry/feature_distance.h"
#include "core/mesh/test_shapes.h"

// Random closed surfaces that cross themselves, judged by the definitions.
namespace cscd {
namespace {

using namespace test;

// How often a closed surface winds around what is just before the middle of a triangle.
int winding_before(const TriangleMesh& mesh, std::span<const Vec3> x, TriangleId at) {
  const auto normal = [&](const Triangle& c) { return (x[+c[1]] - x[+c[0]]).cross(x[+c[2]] - x[+c[0]]); };
  const Triangle& own = mesh.corners(at);
  const Vec3 p = (x[+own[0]] + x[+own[1]] + x[+own[2]]) / 3 + 1e-9 * normal(own).normalized(),
             far = p + Vec3(91.3, 57.7, 33.1);
  int winding = 0;
  for (const Triangle& c : mesh.triangles())
    if (segment_touches_triangle(p, far, x[+c[0]], x[+c[1]], x[+c[2]]))
      winding += normal(c).dot(far - p) > 0 ? 1 : -1;
  return winding;
}

// A surface like a ball that crosses itself: balls and tubes whose vertices are moved far, and a tube that is
// bent into a ring and goes into itself.
test::Shape crossing_ball(int number, std::mt19937& random) {
  std::uniform_real_distribution<double> some(-1, 1);
  test::Shape ball = number % 3 == 0   ? test::icosphere(1)
                     : number % 3 == 1 ? test::capped_tube(6, 6, 0.4, 2)
                                       : test::capped_tube(6, 18, 0.4, 8);
  const double radius = 1.1 + 0.1 * some(random), lift = 0.3 * some(random);
  for (Vec3& x : ball.positions) {
    if (number % 3 == 2) {
      const double angle = x.x() / radius, out = radius + x.y();
      x = Vec3(out * std::sin(angle), out * std::cos(angle), x.z() + lift * angle / 6);
    }
    x += (number % 3 == 2 ? 0.05 : 0.35) * Vec3(some(random), some(random), some(random));
  }
  if (number % 2 != 0)
    for (Triangle& t : ball.triangles) std::swap(t[1], t[2]);
  return ball;
}

// Flat tetrahedra, whose volume is no more than the roundings of its terms.
// Mutation: faces_inward() takes the sign of the rounded volume in all cases.
TEST(Overlaps, KnowWhereFacesOfNearlyEmptyBodiesLook) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(-1, 1);
  const auto v = [](int i) { return VertexId{i}; };
  const TriangleMesh mesh({{v(0), v(1), v(2)}, {v(0), v(3), v(1)}, {v(1), v(3), v(2)}, {v(2), v(3), v(0)}},
                          4);
  const std::vector<TriangleId> all{triangle(0), triangle(1), triangle(2), triangle(3)};
  int wrong = 0;
  std::array<int, 2> seen{};
  for (int n = 0; n < count(); ++n) {
    std::vector<Vec3> x(4);
    for (std::size_t i = 0; i < 3; ++i) x[i] = {some(random), some(random), some(random)};
    x[3] = x[0] + some(random) * (x[1] - x[0]) + some(random) * (x[2] - x[0]);
    GenericSides sides(x);
    const bool inward = sides.side(v(0), v(1), v(2), v(3)) < 0;
    ++seen[inward];
    wrong += inward != faces_inward(mesh, x, all, [](VertexId) { return false; });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(seen[0], count() / 4);
  EXPECT_GT(seen[1], count() / 4);
}

// A needle that goes into the ring where the ring's ends lie in each other: its edges pass two faces of the
// ring from before to behind.
TEST(Overlaps, HoldWhatLiesInTwoLayers) {
  test::Shape ring = test::capped_tube(6, 18, 0.4, 8);
  for (Vec3& x : ring.positions) {
    const double angle = x.x() / 1.1, out = 1.1 + x.y();
    x = Vec3(out * std::sin(angle), out * std::cos(angle), x.z() + 0.2 * angle / 6);
  }
  test::Shape needle{{{-0.1, 0, 3}, {0.1, 0, 3}, {0, 0.1, 3}, {0, 0, 0}},
                     {{VertexId{0}, VertexId{1}, VertexId{2}},
                      {VertexId{0}, VertexId{3}, VertexId{1}},
                      {VertexId{1}, VertexId{3}, VertexId{2}},
                      {VertexId{2}, VertexId{3}, VertexId{0}}}};
  const test::Shape both =
      test::together(test::moved(needle, {1.1 * std::sin(0.5), 1.1 * std::cos(0.5), 0.1}), ring);
  const TriangleMesh mesh = both.mesh();
  OverlapFinder finder(mesh);
  const Overlaps found = finder.find(both.positions, all_pairs(mesh, both.positions));
  std::size_t holding = 0;
  for (const Overlap& overlap : found.overlaps)
    for (const CrossingRegion& region : overlap.regions)
      if (region.own == 0 && region.vertices == std::vector{VertexId{3}}) {
        EXPECT_EQ(region.side, CrossingRegion::Side::behind);
        ++holding;
      }
  EXPECT_EQ(holding, 1u);
}

// Whether all corners of a triangle are in a region, and no curve runs through the triangle.
bool is_whole(const TriangleMesh& mesh, const CrossingRegion& region, const std::set<TriangleId>& cut,
              TriangleId t) {
  return !cut.contains(t) && std::ranges::all_of(mesh.corners(t), [&](VertexId v) {
    return std::ranges::find(region.vertices, v) != region.vertices.end();
  });
}

// A region that lies behind is wound around once more than the surface's own inside is, and one that lies
// before is wound around less than nothing; seen from the other side where faces look inward. Returns how
// many triangles were asked.
std::size_t expect_sides_right(const TriangleMesh& mesh, std::span<const Vec3> x, const Overlaps& found,
                               const std::set<TriangleId>& cut, bool inward) {
  std::size_t asked = 0;
  for (const Overlap& overlap : found.overlaps)
    for (const CrossingRegion& region : overlap.regions) {
      if (region.side == CrossingRegion::Side::smaller) continue;
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        if (!is_whole(mesh, region, cut, triangle(t))) continue;
        const int winding = winding_before(mesh, x, triangle(t));
        if (region.side == CrossingRegion::Side::behind)
          EXPECT_GE(winding, inward ? 0 : 1);
        else
          EXPECT_LE(winding, inward ? -2 : -1);
        ++asked;
      }
    }
  return asked;
}

// Depths where one closed curve parts both sheets, or one of them between its vertices: the other sheet is
// then all triangles that have a vertex in the other region, or that the curve runs through. Returns how many
// points between vertices were held against the bound.
std::size_t expect_depths_right(const TriangleMesh& mesh, std::span<const Vec3> x, const Overlaps& found,
                                const std::set<TriangleId>& cut, std::mt19937& random) {
  std::size_t points = 0;
  std::uniform_real_distribution<double> some(0, 1);
  for (const Overlap& overlap : found.overlaps) {
    const auto on_one_sheet = [](const CrossingRegion& region) {
      return std::ranges::count(region.image, region.image.front()) == std::ssize(region.image);
    };
    if (overlap.curves.size() != 1 || overlap.regions.empty() || overlap.regions.size() > 2 ||
        !found.crossing.curves[static_cast<std::size_t>(overlap.curves.front())].closed() ||
        !std::ranges::all_of(overlap.regions, on_one_sheet))
      continue;
    std::array<std::set<TriangleId>, 2> sheet;
    for_each_segment(found.crossing, overlap, [&](const auto& segment) {
      for (std::size_t s = 0; s < 2; ++s) sheet[s].insert(segment[s]);
    });
    for (const CrossingRegion& region : overlap.regions)
      for (const VertexId v : region.vertices) {
        const std::span<const TriangleId> at = mesh.triangles_at(v);
        sheet[static_cast<std::size_t>(region.image.front() % 2)].insert(at.begin(), at.end());
      }
    for (const CrossingRegion& region : overlap.regions) {
      if (region.other_is_open) continue;
      const auto own = static_cast<std::size_t>(region.image.front() % 2);
      const auto distance = [&](const Vec3& p) {
        double least = 1e300;
        for (const TriangleId t : sheet[1 - own]) {
          const Triangle& c = mesh.corners(t);
          least = std::min(least, squared_point_triangle_distance(p, x[+c[0]], x[+c[1]], x[+c[2]]));
        }
        return std::sqrt(least);
      };
      double deepest = 0;
      for (const VertexId v : region.vertices) deepest = std::max(deepest, distance(x[+v]));
      EXPECT_NEAR(region.depth.lower, deepest, 1e-12);
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        if (!is_whole(mesh, region, cut, triangle(t))) continue;
        const Triangle& c = mesh.triangles()[t];
        for (int i = 0; i < 5; ++i, ++points) {
          const double r = std::sqrt(some(random)), w = some(random);
          EXPECT_LE(distance((1 - r) * x[+c[0]] + r * (1 - w) * x[+c[1]] + r * w * x[+c[2]]),
                    region.depth.upper + 1e-12);
        }
      }
    }
  }
  return points;
}

// Every closed curve of a ball parts it, so an edge changes sides if and only if it is pierced an odd number
// of times.
TEST(Overlaps, PartSurfacesThatCrossThemselves) {
  int crossing = 0;
  std::array<int, 3> sides{};
  std::size_t whole = 0, measured = 0;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    std::mt19937 random(static_cast<unsigned>(n));
    const test::Shape ball = crossing_ball(n, random);
    const TriangleMesh mesh = ball.mesh();
    const std::vector<CrossingPair> pairs = all_pairs(mesh, ball.positions);
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(ball.positions, pairs);
    expect_curves_right(mesh, found.crossing, pairs);
    std::vector<int> piercings(mesh.edge_count(), 0), side(mesh.vertex_count(), -1);
    for (const Piercing& p : found.crossing.piercings) ++piercings[+p.edge];
    for (const CrossingCurve& curve : found.crossing.curves)
      for (const CrossingCurve::Node& node : curve.nodes)
        if (node.piercing < 0) side[+node.vertex] = 2;
    for (std::size_t first = 0; first < side.size(); ++first) {
      if (side[first] >= 0) continue;
      std::vector<std::size_t> open{first};
      side[first] = 0;
      while (!open.empty()) {
        const std::size_t v = open.back();
        open.pop_back();
        for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
          const Edge& ends = mesh.edges()[e];
          if (+ends[0] != v && +ends[1] != v) continue;
          const std::size_t other = +ends[0] == v ? +ends[1] : +ends[0];
          if (side[other] == 2) continue;
          const int expected = side[v] ^ (piercings[e] & 1);
          if (side[other] < 0) side[other] = expected, open.push_back(other);
          EXPECT_EQ(side[other], expected);
        }
      }
    }
    std::set<TriangleId> cut;
    for (const auto& [a, b] : pairs) cut.insert({a, b});
    for (const Overlap& overlap : found.overlaps)
      for (const CrossingRegion& region : overlap.regions) {
        EXPECT_LE(region.depth.lower, region.depth.upper);
        sides[static_cast<std::size_t>(region.side)] += 1;
      }
    whole += expect_sides_right(mesh, ball.positions, found, cut, n % 2 != 0);
    measured += expect_depths_right(mesh, ball.positions, found, cut, random);
    crossing += !found.overlaps.empty();
    if (HasFailure()) return;
  }
  EXPECT_GT(crossing, count() / 2);
  EXPECT_GT(sides[0], count() / 4);
  EXPECT_GT(sides[1], count() / 4);
  EXPECT_LT(sides[2], count() / 10) << "most outermost vertices say how often the surface winds";
  EXPECT_GT(whole, count());
  EXPECT_GT(measured, count());
}

}  // namespace
}  // namespace cscd
