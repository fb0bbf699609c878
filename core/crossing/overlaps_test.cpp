#include "core/crossing/overlaps.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <string>

#include "core/crossing/generic_side.h"
#include "core/crossing/length_gradient.h"
#include "core/crossing/self_winding.h"
#include "core/detect/start/embedding.h"
#include "core/elementary/exact/static_contact.h"
#include "core/geometry/feature_distance.h"
#include "core/mesh/adjacency.h"
#include "core/mesh/test_shapes.h"

// Random closed surfaces, judged by the definitions: all pairs of triangles, and parities along rays.
namespace cscd {
namespace {

using End = CrossingCurve::End;

// How many surfaces of each kind; more by CSCD_RANDOM_SURFACES=10000.
int count() {
  const char* asked = std::getenv("CSCD_RANDOM_SURFACES");
  return asked != nullptr ? std::atoi(asked) : 1000;
}

TriangleId triangle(std::size_t t) {
  return TriangleId{static_cast<std::int32_t>(t)};
}

std::vector<CrossingPair> all_pairs(const TriangleMesh& mesh, std::span<const Vec3> x) {
  std::vector<CrossingPair> out;
  for (std::size_t a = 0; a < mesh.triangle_count(); ++a)
    for (std::size_t b = a + 1; b < mesh.triangle_count(); ++b)
      if (triangles_meet(mesh, x, triangle(a), triangle(b))) out.emplace_back(triangle(a), triangle(b));
  return out;
}

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

// Each pair that crosses is in one curve once; neighbouring segments have neighbouring triangles; curves end
// at shared vertices alone, as the surface is closed.
void expect_curves_right(const TriangleMesh& mesh, const CrossingCurves& found,
                         std::span<const CrossingPair> pairs) {
  std::set<CrossingPair> seen;
  std::size_t known = 0;
  for (const CrossingCurve& curve : found.curves) {
    EXPECT_TRUE(curve.closed() || (curve.first == End::vertex && curve.last == End::vertex));
    ASSERT_EQ(curve.nodes.size(), curve.segments.size() + !curve.closed());
    for (std::size_t i = 0; i < curve.segments.size(); ++i) {
      const auto [a, b] = curve.segments[i];
      EXPECT_TRUE(seen.insert(std::minmax(a, b)).second);
      known += std::ranges::binary_search(pairs, CrossingPair(std::minmax(a, b)));
      if (!curve.closed() && i + 1 == curve.segments.size()) continue;
      const CrossingCurve::Node& node = curve.nodes[(i + 1) % curve.nodes.size()];
      const Piercing& p = found.piercings[static_cast<std::size_t>(node.piercing)];
      const auto& next = curve.segments[(i + 1) % curve.segments.size()];
      // A curve may come back with its sheets exchanged.
      const bool exchanged = i + 1 == curve.segments.size() && next[1U - node.edge_sheet] != p.face;
      EXPECT_EQ(p.face, curve.segments[i][1U - node.edge_sheet]);
      EXPECT_EQ(p.face, next[exchanged ? node.edge_sheet : 1U - node.edge_sheet]);
      const auto at_edge = mesh.triangles_at(p.edge);
      const std::set<TriangleId> both{curve.segments[i][node.edge_sheet],
                                      next[exchanged ? 1U - node.edge_sheet : node.edge_sheet]};
      EXPECT_EQ(both, std::set<TriangleId>(at_edge.begin(), at_edge.end()));
    }
  }
  EXPECT_EQ(known + found.touching, pairs.size());
  if (found.degenerate == 0) {
    EXPECT_EQ(known, seen.size());
  }
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

// On a coarse grid, vertices lie in faces, edges meet, and triangles lie in one plane.
TEST(Overlaps, HaveWholeCurvesWhereSurfacesTouchExactly) {
  std::size_t degenerate = 0, touching = 0;
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
    if (HasFailure()) return;
  }
  EXPECT_GT(degenerate, 100U);
  EXPECT_GT(touching, 100U);
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
  int wrong = 0;
  std::array<int, 2> seen{};
  for (int n = 0; n < count(); ++n) {
    std::vector<Vec3> x(4);
    for (std::size_t i = 0; i < 3; ++i) x[i] = {some(random), some(random), some(random)};
    x[3] = x[0] + some(random) * (x[1] - x[0]) + some(random) * (x[2] - x[0]);
    GenericSides sides(x);
    const bool inward = sides.side(v(0), v(1), v(2), v(3)) < 0;
    ++seen[inward];
    wrong += inward != faces_inward(mesh, x, 0, [](VertexId) { return false; });
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
