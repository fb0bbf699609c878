#include "core/crossing/overlaps.h"

#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include "core/crossing/length_gradient.h"
#include "core/crossing/test_overlaps.h"
#include "core/elementary/exact/static_contact.h"
#include "core/geometry/feature_distance.h"
#include "core/geometry/nearest_points.h"
#include "core/mesh/test_shapes.h"

// Random closed surfaces, judged by the definitions: all pairs of triangles, and parities along rays.
namespace cscd {
namespace {

using namespace test;

// Two shapes of one component each, turned, dented and pushed into each other.
struct Pushed {
  explicit Pushed(unsigned seed) : random(seed) {
    const auto shape = [&] {
      switch (random() % 4) {
        case 0:
          return test::octahedron();
        case 1:
          return test::icosphere(1);
        case 2:
          return test::moved(test::torus(8, 5), Vec3::Zero(), 0.5);
        default:
          return test::moved(test::capped_tube(5, 4, 0.3, 2), {-1, 0, 0});
      }
    };
    const test::Shape first = shape();
    half = first.positions.size();
    shapes = test::together(first, shape());
    const Vec3 move = 1.2 * draw();
    const Eigen::AngleAxisd turn(3 * some(random), draw().normalized());
    for (std::size_t v = 0; v < shapes.positions.size(); ++v) {
      Vec3& x = shapes.positions[v];
      if (v >= half) x = turn * x + move;
      x += 0.1 * draw();
    }
  }
  Vec3 draw() { return {some(random), some(random), some(random)}; }

  std::mt19937 random;
  std::uniform_real_distribution<double> some{-1, 1};
  std::size_t half = 0;
  test::Shape shapes;
};

// Whether a point lies inside a closed component: an odd number of its triangles lie on a ray.
bool is_inside(const TriangleMesh& mesh, std::span<const Vec3> x, std::int32_t component, const Vec3& p) {
  const Vec3 far = p + Vec3(91.3, 57.7, 33.1);
  bool odd = false;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& c = mesh.triangles()[t];
    if (mesh.component(triangle(t)) == component)
      odd ^= segment_touches_triangle(p, far, x[+c[0]], x[+c[1]], x[+c[2]]);
  }
  return odd;
}

TEST(Overlaps, OfRandomClosedSurfacesAreTrue) {
  int with_regions = 0, deep = 0, between = 0;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    Pushed pushed(static_cast<unsigned>(n));
    const TriangleMesh mesh = pushed.shapes.mesh();
    const std::vector<Vec3>& x = pushed.shapes.positions;
    const std::vector<CrossingPair> pairs = all_pairs(mesh, x);
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(x, pairs, true);
    expect_curves_right(mesh, found.crossing, pairs);
    if (HasFailure()) return;

    bool embedded[2] = {true, true}, cross = false;
    for (const auto& [a, b] : pairs) {
      if (mesh.component(a) == mesh.component(b))
        embedded[mesh.component(a)] = false;
      else
        cross = true;
    }
    if (!embedded[0] || !embedded[1] || !cross) continue;
    std::set<VertexId> inside, beyond;
    for (std::size_t v = 0; v < x.size(); ++v)
      if (is_inside(mesh, x, v < pushed.half ? 1 : 0, x[v])) inside.insert(VertexId{static_cast<int>(v)});
    for (const Overlap& overlap : found.overlaps)
      for (const CrossingRegion& region : overlap.regions) {
        EXPECT_EQ(region.side, CrossingRegion::Side::behind);
        EXPECT_FALSE(region.other_is_open);
        for (const VertexId v : region.vertices) EXPECT_TRUE(beyond.insert(v).second);
        with_regions += 1;
      }
    EXPECT_EQ(beyond, inside);

    // Where all hangs together, the other sheet is all triangles that lie inside or are cut.
    if (found.overlaps.size() != 1) continue;
    std::set<TriangleId> sheet;
    for (const auto& [a, b] : pairs) sheet.insert({a, b});
    for (const VertexId v : inside)
      for (const TriangleId t : mesh.triangles_at(v)) sheet.insert(t);
    const auto distance_to_other = [&](const Vec3& p, std::int32_t own) {
      double least = 1e300;
      for (const TriangleId t : sheet) {
        const Triangle& c = mesh.corners(t);
        if (mesh.component(t) != own)
          least = std::min(least, squared_point_triangle_distance(p, x[+c[0]], x[+c[1]], x[+c[2]]));
      }
      return std::sqrt(least);
    };
    const Overlap& overlap = found.overlaps.front();
    double deepest = 0;
    for (const VertexId v : inside)
      deepest = std::max(deepest, distance_to_other(x[+v], +v < pushed.half ? 0 : 1));
    if (overlap.depth.vertex == VertexId{-1} && overlap.depth.lower > 0) {
      const std::int32_t own = 1 - mesh.component(overlap.depth.nearest);
      EXPECT_TRUE(is_inside(mesh, x, 1 - own, overlap.depth.point));
      EXPECT_NEAR(overlap.depth.lower, distance_to_other(overlap.depth.point, own), 1e-12);
      between += 1;
    } else if (found.crossing.curves.size() == 1) {
      EXPECT_NEAR(overlap.depth.lower, deepest, 1e-12);
    }
    for (const CrossingRegion& region : overlap.regions)
      for (std::size_t i = 0; i < region.vertices.size(); ++i) {
        const Vec3& from = x[+region.vertices[i]];
        EXPECT_GE(region.way[i].norm(), distance_to_other(from, region.own) - 1e-12);
        EXPECT_LE(distance_to_other(from + region.way[i], region.own), 1e-12)
            << "a way ends on the other sheet";
      }
    EXPECT_GE(overlap.depth.lower, deepest - 1e-12);
    EXPECT_LE(overlap.depth.lower, overlap.depth.upper);
    if (overlap.depth.vertex != VertexId{-1}) {
      EXPECT_TRUE(inside.contains(overlap.depth.vertex));
      EXPECT_NEAR(overlap.depth.out.norm(), overlap.depth.lower, 1e-12);
    }
    // Any point of a sheet that lies inside the other.
    for (int i = 0; i < 300; ++i) {
      const std::size_t t = pushed.random() % mesh.triangle_count();
      const Triangle& c = mesh.triangles()[t];
      const double u = std::abs(pushed.some(pushed.random)), w = std::abs(pushed.some(pushed.random));
      const double r = std::sqrt(u);
      const Vec3 p = (1 - r) * x[+c[0]] + r * (1 - w) * x[+c[1]] + r * w * x[+c[2]];
      const std::int32_t own = mesh.component(triangle(t));
      if (!is_inside(mesh, x, 1 - own, p)) continue;
      EXPECT_LE(distance_to_other(p, own), overlap.depth.upper + 1e-12);
      deep += 1;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(with_regions, count() / 2);
  EXPECT_GT(deep, count());
  EXPECT_GT(between, count() / 50);
}

// The regions of some components, each by its vertices, and how deep it is.
std::set<std::pair<std::vector<VertexId>, double>> regions_of(const Overlaps& found,
                                                              const std::vector<bool>& wanted) {
  std::set<std::pair<std::vector<VertexId>, double>> out;
  for (const Overlap& overlap : found.overlaps)
    for (const CrossingRegion& region : overlap.regions) {
      if (!wanted[static_cast<std::size_t>(region.own)] || !wanted[static_cast<std::size_t>(region.other)])
        continue;
      std::vector<VertexId> vertices = region.vertices;
      std::ranges::sort(vertices);
      out.emplace(vertices, region.depth.lower);
    }
  return out;
}

// Of four bodies, one of them with a hole or not, any two lie in each other as they would alone.
// Mutations: an edge is parted by the faces of all components together; a group has one fragment alone.
TEST(Overlaps, OfManyBodiesAreThoseOfEachTwo) {
  int compared = 0, differ = 0;
  for (int n = 0; n < count() / 2; ++n) {
    Pushed first(static_cast<unsigned>(n)), second(static_cast<unsigned>(n) + 5000);
    test::Shape all =
        test::together(first.shapes, test::moved(second.shapes, 0.7 * first.draw(), 1 + 0.3 * n / count()));
    if (n % 2 != 0) all.triangles.pop_back();
    const std::vector<Vec3>& x = all.positions;
    const TriangleMesh mesh = all.mesh();
    ASSERT_EQ(mesh.component_count(), 4);
    const std::vector<CrossingPair> pairs = all_pairs(mesh, x);
    OverlapFinder finder(mesh);
    const Overlaps together = finder.find(x, pairs);
    if (together.crossing.degenerate > 0) continue;
    for (std::int32_t one = 0; one < 4; ++one)
      for (std::int32_t two = one + 1; two < 4; ++two) {
        std::vector<Triangle> triangles;
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
          if (const std::int32_t c = mesh.component(triangle(t)); c == one || c == two)
            triangles.push_back(mesh.triangles()[t]);
        const TriangleMesh both(triangles, x.size(), "two of the bodies");
        OverlapFinder alone(both);
        const auto expected = regions_of(alone.find(x, all_pairs(both, x)), {true, true});
        std::vector<bool> wanted(4, false);
        wanted[static_cast<std::size_t>(one)] = wanted[static_cast<std::size_t>(two)] = true;
        differ += regions_of(together, wanted) != expected;
        compared += !expected.empty();
      }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(compared, count() / 2);
}

// The gradient of the length of all curves against difference quotients, where the curves stay between the
// same triangles.
TEST(Overlaps, SayHowCurvesGrow) {
  int compared = 0;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    Pushed pushed(static_cast<unsigned>(n));
    const TriangleMesh mesh = pushed.shapes.mesh();
    const std::vector<Vec3>& x = pushed.shapes.positions;
    const std::vector<CrossingPair> pairs = all_pairs(mesh, x);
    std::vector<Vec3> move(x.size());
    for (Vec3& way : move) way = pushed.draw();
    OverlapFinder finder(mesh);
    const auto length_at = [&](double step, double* slope) {
      std::vector<Vec3> moved = x;
      for (std::size_t v = 0; v < x.size(); ++v) moved[v] += step * move[v];
      const Overlaps found = finder.find(moved, pairs);
      double length = 0;
      for (const Overlap& overlap : found.overlaps) {
        const CurveLength all = length_gradient(mesh, moved, found.crossing, overlap);
        length += all.length;
        if (slope == nullptr) continue;
        for (const auto& [v, gradient] : all.gradient) *slope += gradient.dot(move[+v]);
      }
      return length;
    };
    double slope = 0;
    constexpr double kStep = 1e-6;
    const double length = length_at(0, &slope), before = length_at(-kStep, nullptr),
                 after = length_at(kStep, nullptr);
    // Where the length bends within the step, curves have come to other triangles, or nearly so.
    const double bend = std::abs(after + before - 2 * length) / kStep;
    if (length == 0 || bend > 1e-3) continue;
    EXPECT_NEAR((after - before) / (2 * kStep), slope, 1e-3 * (1 + std::abs(slope)));
    ++compared;
    if (HasFailure()) return;
  }
  EXPECT_GT(compared, count() / 2);
}

void expect_scaled(const CrossingDepth& found, const CrossingDepth& expected, double unit) {
  EXPECT_EQ(found.lower, unit * expected.lower);
  EXPECT_EQ(found.upper, unit * expected.upper);
  EXPECT_EQ(found.point, unit * expected.point);
  EXPECT_EQ(found.out, unit * expected.out);
  EXPECT_EQ(found.vertex, expected.vertex);
}

// Mutations: OverlapFinder::find() or length_gradient() computes in the scale of the pose, where fourth
// powers of lengths overflow or vanish.
TEST(Overlaps, DoNotDependOnTheUnitOfLength) {
  std::size_t regions = 0;
  for (unsigned n = 0; n < 30; ++n)
    for (const int exponent : {-900, -500, -330, -61, 61, 260, 500, 900}) {
      SCOPED_TRACE(std::to_string(n) + " at 2^" + std::to_string(exponent));
      const Pushed pushed(n);
      const TriangleMesh mesh = pushed.shapes.mesh();
      std::vector<Vec3> x = pushed.shapes.positions;
      const std::vector<CrossingPair> pairs = all_pairs(mesh, x);
      OverlapFinder finder(mesh);
      const Overlaps expected = finder.find(x, pairs, true);
      std::vector<CurveLength> lengths;
      for (const Overlap& overlap : expected.overlaps)
        lengths.push_back(length_gradient(mesh, x, expected.crossing, overlap));
      const double unit = std::ldexp(1.0, exponent);
      for (Vec3& p : x) p *= unit;
      const Overlaps found = finder.find(x, pairs, true);
      ASSERT_EQ(found.overlaps.size(), expected.overlaps.size());
      for (std::size_t p = 0; p < found.crossing.piercings.size(); ++p)
        EXPECT_EQ(found.crossing.piercings[p].point, unit * expected.crossing.piercings[p].point);
      for (std::size_t i = 0; i < found.overlaps.size(); ++i) {
        const Overlap &one = found.overlaps[i], &other = expected.overlaps[i];
        expect_scaled(one.depth, other.depth, unit);
        const CurveLength length = length_gradient(mesh, x, found.crossing, one);
        EXPECT_EQ(length.length, unit * lengths[i].length);
        EXPECT_EQ(length.gradient, lengths[i].gradient);
        ASSERT_EQ(one.regions.size(), other.regions.size());
        for (std::size_t r = 0; r < one.regions.size(); ++r, ++regions) {
          expect_scaled(one.regions[r].depth, other.regions[r].depth, unit);
          EXPECT_EQ(one.regions[r].vertices, other.regions[r].vertices);
          EXPECT_EQ(one.regions[r].side, other.regions[r].side);
          EXPECT_EQ(one.regions[r].area, unit * (unit * other.regions[r].area));
          for (std::size_t v = 0; v < one.regions[r].way.size(); ++v)
            EXPECT_EQ(one.regions[r].way[v], unit * other.regions[r].way[v]);
        }
      }
      if (HasFailure()) return;
    }
  EXPECT_GT(regions, 100U);
}

// Mutation: the bound of a depth is rounded to the nearest subnormal number.
TEST(Overlaps, HaveBoundsThatHoldWhereLengthsAreSubnormal) {
  int deep = 0;
  for (unsigned n = 0; n < 100; ++n) {
    SCOPED_TRACE(n);
    const Pushed pushed(n);
    const TriangleMesh mesh = pushed.shapes.mesh();
    std::vector<Vec3> tiny = pushed.shapes.positions, same = tiny;
    for (std::size_t v = 0; v < tiny.size(); ++v) {
      tiny[v] *= 0x1p-1066;
      same[v] = tiny[v] * 0x1p1000 * 0x1p66;
    }
    const std::vector<CrossingPair> pairs = all_pairs(mesh, same);
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(tiny, pairs), expected = finder.find(same, pairs);
    ASSERT_EQ(found.overlaps.size(), expected.overlaps.size());
    for (std::size_t i = 0; i < found.overlaps.size(); ++i, ++deep) {
      const double bound = found.overlaps[i].depth.upper * 0x1p1000 * 0x1p66;
      EXPECT_GE(bound, expected.overlaps[i].depth.upper);
      EXPECT_LE(bound, expected.overlaps[i].depth.upper + 0x1p-8);
    }
  }
  EXPECT_GT(deep, 50);
}

double distance_to(const TriangleMesh& mesh, std::span<const Vec3> x, std::int32_t component, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& c = mesh.triangles()[t];
    if (mesh.component(triangle(t)) == component)
      least = std::min(least, nearest_of_vertex_face({p, x[+c[0]], x[+c[1]], x[+c[2]]}).way.norm());
  }
  return least;
}

// On a coarse grid, vertices lie in faces, edges meet, and triangles lie in one plane. What lies on the other
// sheet is not deep in it, whatever side of it the tie is broken to.
TEST(Overlaps, HaveWholeCurvesWhereSurfacesTouchExactly) {
  std::size_t degenerate = 0, touching = 0, deep = 0;
  for (int n = 0; n < count() / 5; ++n) {
    SCOPED_TRACE(n);
    Pushed pushed(static_cast<unsigned>(n));
    for (Vec3& x : pushed.shapes.positions) x = (4 * x).array().round() / 4;
    const TriangleMesh mesh = pushed.shapes.mesh();
    const std::vector<CrossingPair> pairs = all_pairs(mesh, pushed.shapes.positions);
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(pushed.shapes.positions, pairs);
    expect_curves_right(mesh, found.crossing, pairs);
    degenerate += found.crossing.degenerate;
    touching += found.crossing.touching;
    for (const Overlap& overlap : found.overlaps)
      for (const CrossingRegion& region : overlap.regions) {
        if (region.own == region.other || region.depth.lower == 0) continue;
        ++deep;
        EXPECT_GT(distance_to(mesh, pushed.shapes.positions, region.other, region.depth.point), 1e-9);
      }
    if (HasFailure()) return;
  }
  EXPECT_GT(degenerate, 100U);
  EXPECT_GT(touching, 100U);
  EXPECT_GT(deep, 100U);
}

// A tetrahedron with an edge in a sheet has two vertices on it and two off it. The tie may be broken so that
// the sheet parts them; but the edge alone is beyond it.
TEST(Overlaps, OfAnEdgeThatRestsOnASheetHaveNoDepth) {
  std::mt19937 random(3);
  const auto draw = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random) / 8.0; };
  std::size_t curves = 0;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    const double up = n % 2 == 0 ? 1 : -1;
    test::Shape tetrahedron{
        {{draw(2, 30), draw(2, 30), 0},
         {draw(2, 30), draw(2, 30), 0},
         {draw(2, 30), draw(2, 30), up * draw(1, 12)},
         {draw(2, 30), draw(2, 30), up * draw(1, 12)}},
        {test::corners(0, 1, 2), test::corners(0, 3, 1), test::corners(0, 2, 3), test::corners(1, 3, 2)}};
    const std::vector<Vec3>& x = tetrahedron.positions;
    if (std::abs((x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0]))) < 1e-6) continue;
    const test::Shape both = test::together(test::moved(test::sheet(4), {2, 2, 0}, 2), tetrahedron);
    const TriangleMesh mesh = both.mesh();
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(both.positions, all_pairs(mesh, both.positions));
    for (const Overlap& overlap : found.overlaps) EXPECT_LT(overlap.depth.lower, 1e-12);
    curves += found.crossing.curves.size();
  }
  EXPECT_GT(curves, 100U);
}

// An octahedron whose middle lies on an edge of a box: all its corners lie on the box or outside, but edges
// between them lead through the box.
TEST(Overlaps, OfEdgesBetweenCornersThatLieOnTheOtherSheetHaveADepth) {
  const test::Shape both =
      test::together(test::box({0, 0, 0}, {2, 2, 2}), test::moved(test::octahedron(), {1, 2, 0}));
  const TriangleMesh mesh = both.mesh();
  OverlapFinder finder(mesh);
  const Overlaps found = finder.find(both.positions, all_pairs(mesh, both.positions));
  double deepest = 0;
  for (const Overlap& overlap : found.overlaps) deepest = std::max(deepest, overlap.depth.lower);
  EXPECT_GE(deepest, 0.5 - 1e-12);
  EXPECT_LE(deepest, 0.6);
}

// Walls of equal boxes lie in one plane when one box is shifted along an axis. No point of what the boxes
// share is deeper than that is thick.
TEST(Overlaps, OfShiftedBoxesAreNoDeeperThanWhatTheyShareIsThick) {
  std::mt19937 random(5);
  const auto draw = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution(low, high)(random));
  };
  std::size_t crossing = 0;
  for (int n = 0; n < count(); ++n) {
    SCOPED_TRACE(n);
    const Vec3 size(draw(1, 12), draw(1, 12), draw(1, 12));
    const auto axis = static_cast<Eigen::Index>(n % 3);
    const Vec3 shift = draw(-12, 12) * Vec3::Unit(axis);
    const test::Shape box = test::box({0, 0, 0}, size);
    const test::Shape both = test::together(box, test::moved(box, shift));
    const TriangleMesh mesh = both.mesh();
    OverlapFinder finder(mesh);
    const Overlaps found = finder.find(both.positions, all_pairs(mesh, both.positions));
    for (const Overlap& overlap : found.overlaps) {
      ++crossing;
      EXPECT_LE(overlap.depth.lower, std::max(1e-12, size[axis] - std::abs(shift[axis])));
      EXPECT_GE(overlap.depth.upper, overlap.depth.lower);
    }
  }
  EXPECT_GT(crossing, 100U);
}

// The same geometry with its vertices, triangles and corners in another order.
test::Shape renumbered(const test::Shape& shape, std::mt19937& random) {
  std::vector<std::size_t> to(shape.positions.size());
  std::iota(to.begin(), to.end(), std::size_t{0});
  std::ranges::shuffle(to, random);
  test::Shape out = shape;
  for (std::size_t v = 0; v < to.size(); ++v) out.positions[to[v]] = shape.positions[v];
  for (Triangle& t : out.triangles) {
    for (VertexId& v : t) v = VertexId{static_cast<std::int32_t>(to[static_cast<std::size_t>(+v)])};
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
  }
  std::ranges::shuffle(out.triangles, random);
  return out;
}

// Ties are broken by the numbers of vertices, and how deep something lies must not depend on them. Worked out
// by hand: bodies, and the depth of one in the other. Mutations: a vertex is held against what its own curve
// cuts off alone; walls that triangles only touch are no skin; what has no curve lies in nothing.
TEST(Overlaps, AreAsDeepInEveryNumbering) {
  using test::box;
  const test::Shape tetrahedron{
      {{2, 2, 3}, {1, 1, 0}, {3, 1, 0}, {2, 3, 0}},
      {test::corners(0, 1, 2), test::corners(0, 2, 3), test::corners(0, 3, 1), test::corners(1, 3, 2)}};
  const test::Shape room = box({0, 0, 0}, {4, 4, 4});
  const std::tuple<const char*, test::Shape, test::Shape, double> cases[] = {
      {"in a room, flush with a wall", room, box({0, 1, 1}, {2, 3, 3}), 2},
      {"in a room, flush with three walls", room, box({0, 0, 0}, {2, 2, 2}), 2},
      {"in a room, on its floor", room, tetrahedron, 3},
      {"in a room, off the grid of its wall", room, box({0, 1.5, 1}, {2, 3.5, 3}), 2},
      {"on one triangle of a wall", room, box({0, 0.5, 2.5}, {2, 1, 3}), 2},
      {"a sheet in a room, a vertex on its wall",
       room,
       {{{0, 2, 2}, {2, 1, 2}, {2, 3, 2}}, {test::corners(0, 1, 2)}},
       1},
      {"two walls flush", box({2, 3, 1}, {4, 4, 3}), box({1, 2, 2}, {4, 4, 4}), 1},
      {"pressed in, a side flush", room, box({0, 1, 3.5}, {2, 3, 6}), 0.5},
      {"resting on it", room, box({1, 1, 4}, {3, 3, 6}), 0}};
  std::mt19937 random(7);
  for (const auto& [name, one, other, depth] : cases)
    for (int n = 0; n < 60; ++n) {
      SCOPED_TRACE(std::string(name) + ", numbering " + std::to_string(n));
      const test::Shape both = renumbered(test::together(one, other), random);
      const TriangleMesh mesh = both.mesh();
      OverlapFinder finder(mesh);
      const Overlaps found = finder.find(both.positions, all_pairs(mesh, both.positions), n % 2 == 1);
      double deepest = 0;
      for (const Overlap& overlap : found.overlaps) deepest = std::max(deepest, overlap.depth.lower);
      ASSERT_NEAR(deepest, depth, 1e-12);
      if (depth > 0) {
        EXPECT_GE(found.overlaps.front().depth.upper, depth - 1e-12);
      }
    }
}

}  // namespace
}  // namespace cscd
