#include "core/elementary/question/relative_box.h"

#include <cfloat>
#include <gtest/gtest.h>

#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

// Rule relative-motion. A corner of one triangle lies exactly on the other triangle at t = 1/2. The touch
// is exact, because all coordinates, the common motion and the offset are small multiples of a power of
// two.
TEST(RelativeBox, NeverSeparatesTrianglesThatTouch) {
  QueryMaker make(1);
  const auto integer = [&](int n) { return static_cast<double>(make.below(2 * n + 1) - n); };
  const auto point = [&](int n) { return Vec3(integer(n), integer(n), integer(n)); };
  int separated_without_touch = 0;
  for (int i = 0; i < 40'000; ++i) {
    const Vec3 common = i % 2 ? 1e6 * point(5) : Vec3(0, 0, 0),
               offset = i % 3 ? 1e6 * point(3) : Vec3(0, 0, 0);
    const double unit = i % 5 ? 1 : 0x1p-20;
    const auto path = [&](const Vec3& middle, const Vec3& speed) {
      return MovingPoint{offset + unit * (middle - speed) - common,
                         offset + unit * (middle + speed) + common};
    };
    Vec3 a[3], b[3];
    for (int k = 0; k < 3; ++k) a[k] = 4 * point(3), b[k] = 4 * point(3);
    const int u = make.below(5), v = make.below(5 - u);
    b[0] = a[0] + u * (a[1] - a[0]) / 4 + v * (a[2] - a[0]) / 4;
    // Each triangle moves as a whole, so the two touch at t = 1/2 for any two speeds.
    const Vec3 speed_a = point(2), speed_b = point(2);
    const MovingPoint first[3] = {path(a[0], speed_a), path(a[1], speed_a), path(a[2], speed_a)};
    MovingPoint second[3] = {path(b[0], speed_b), path(b[1], speed_b), path(b[2], speed_b)};
    ASSERT_FALSE(relative_boxes_apart(first, second)) << i;
    ASSERT_FALSE(relative_boxes_apart(second, first)) << i;
    for (MovingPoint& p : second)
      for (Vec3* end : {&p.start, &p.end}) *end += unit * Vec3(40, 0, 0);
    separated_without_touch += relative_boxes_apart(first, second);
  }
  EXPECT_GT(separated_without_touch, 30'000);
}

// Boxes that share one number on one axis touch. A hair further they are apart.
TEST(RelativeBox, IsTightAtRest) {
  const auto still = [](double x) { return MovingPoint{{x, 0, 0}, {x, 0, 0}}; };
  const MovingPoint a[2] = {still(0), still(1)}, touching[2] = {still(1), still(2)},
                    beyond[2] = {still(std::nextafter(1, 2)), still(2)};
  EXPECT_FALSE(relative_boxes_apart(a, touching));
  EXPECT_FALSE(relative_boxes_apart(touching, a));
  EXPECT_TRUE(relative_boxes_apart(a, beyond));
  EXPECT_TRUE(relative_boxes_apart(beyond, a));
}

// At a distance, boxes have to be farther apart than that by more than roundings. The oracle finds close
// what is exactly as far apart.
TEST(RelativeBox, AtADistanceLeavesRoomForRoundings) {
  const MovingEdgeEdge query{{test::still(0, 0, 0), test::still(1, 0, 0)},
                             {test::still(3, 0, 0), test::still(4, 0, 0)}};
  EXPECT_TRUE(exact::first_closeness(query, 2));
  EXPECT_FALSE(relative_boxes_apart(query, 2));
  EXPECT_TRUE(relative_boxes_apart(query, 2 - 1e-14));
  QueryMaker make(58);
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    FourMovingPoints points = make.any();
    const Vec3 common = 1e6 * make.vector();
    for (MovingPoint& p : points) p.end += common;
    const auto edges = query_of<MovingEdgeEdge>(points);
    // A distance just below and just above the largest at which the boxes are apart.
    double low = 0, high = 8;
    for (int k = 0; k < 60; ++k)
      (relative_boxes_apart(edges, low + (high - low) / 2) ? low : high) = low + (high - low) / 2;
    apart += low > 0;
    ASSERT_TRUE(low == 0 || !exact::first_closeness(edges, low)) << i;
  }
  EXPECT_GT(apart, 200);
}

TEST(RelativeBox, SeparatesNeighboursThatMoveTogether) {
  QueryMaker make(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 common = 100 * make.vector();
    const auto moving = [&](const Vec3& x) { return MovingPoint{x, x + common + 0.01 * make.vector()}; };
    const MovingPoint a[3] = {moving(make.vector()), moving(make.vector()), moving(make.vector())};
    const Vec3 shift = Vec3::Unit(i % 3) * (i % 2 ? 2.1 : -2.1);
    const MovingPoint b[3] = {moving(make.vector() + shift), moving(make.vector() + shift),
                              moving(make.vector() + shift)};
    ASSERT_TRUE(relative_boxes_apart(a, b));
  }
}

// The oracle confirms that features whose boxes are apart do not touch.
template <class Query>
void expect_sound(double scale, double common_scale, unsigned seed) {
  QueryMaker make(seed);
  int apart = 0, contacts = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = make.uniform(0, 1), u = make.below(3) / 2.0, v = make.below(2) * (1 - u);
    FourMovingPoints p = i % 4 == 0                                ? make.any()
                         : std::is_same_v<Query, MovingVertexFace> ? test::vertex_meets_face(make, t, u, v)
                                                                   : test::edge_meets_edge(make, t, u, v);
    const Vec3 common = common_scale * make.vector();
    for (MovingPoint& x : p) x = {scale * x.start, scale * x.end + common};
    const Query query = query_of<Query>(p);
    const bool separated = relative_boxes_apart(query);
    apart += separated;
    if (!separated) continue;
    const auto contact = exact::first_contact(query);
    contacts += contact.has_value();
    ASSERT_FALSE(contact) << "scale " << scale;
  }
  EXPECT_GT(apart, 0);
}

TEST(RelativeBox, SeparatesOnlyWhatTheOracleCallsApart) {
  for (const auto& [scale, common] :
       {std::pair{1.0, 0.0}, {1.0, 1e6}, {1e6, 1e6}, {1e-3, 1e6}, {1e-9, 1e7}}) {
    expect_sound<MovingVertexFace>(scale, common, 3);
    expect_sound<MovingEdgeEdge>(scale, common, 4);
  }
}

// Velocities of opposite sign overflow, so their mean is not a number.
TEST(RelativeBox, KeepsWhatOverflows) {
  const MovingPoint right{{-DBL_MAX, 0, 0}, {DBL_MAX, 0, 0}}, left{{DBL_MAX, 0, 0}, {-DBL_MAX, 0, 0}};
  const MovingPoint a[2] = {right, right}, b[2] = {left, left};
  EXPECT_FALSE(relative_boxes_apart(a, b));  // they meet at t = 1/2
  EXPECT_FALSE(relative_boxes_apart(b, a));
  EXPECT_TRUE(exact::first_contact(MovingEdgeEdge{{right, right}, {left, left}}));
  const MovingPoint c[2] = {right, right}, d[2] = {right, {{DBL_MAX, 1, 1}, {DBL_MAX, 1, 1}}};
  EXPECT_FALSE(relative_boxes_apart(c, d));
  EXPECT_FALSE(relative_boxes_apart(d, c));
}

}  // namespace
}  // namespace cscd
