#include "core/radial/orientation.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

#include "core/elementary/question/test_queries.h"
#include "core/geometry/bernstein.h"
#include "core/radial/test_exact_orientation.h"

namespace cscd::radial {
namespace {

using test::still;
using Corners = MovingPoint[3];

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  Vec3 in_box(double half) { return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)}; }
  MovingPoint moving(double half, double speed) {
    const Vec3 start = in_box(half);
    return {start, start + in_box(speed)};
  }

 private:
  std::mt19937_64 engine_;
};

// Unit and origin of a test: p becomes scale p + offset, rounded.
struct Place {
  double scale;
  Vec3 offset;
  MovingPoint operator()(const MovingPoint& p) const {
    return {scale * p.start + offset, scale * p.end + offset};
  }
};
const Place kPlaces[] = {
    {1, Vec3::Zero()},     {1, {1e6, -3e6, 7e5}}, {1e-3, {1e8, 1e8, -1e8}},
    {1e-80, Vec3::Zero()}, {1e80, Vec3::Zero()},  {1e-9, {1, 1, 1}},
};

// Returns an observer that is a few ulps off the plane of a triangle at both ends.
MovingPoint near_plane(const Corners& corner, Dice& dice) {
  const auto pick = [&](Vec3 a, Vec3 b, Vec3 c) -> Vec3 {
    const double v = dice(-2, 3), w = dice(-2, 3);
    return a + v * (b - a) + w * (c - a);
  };
  return {pick(corner[0].start, corner[1].start, corner[2].start),
          pick(corner[0].end, corner[1].end, corner[2].end)};
}

// Returns the cubic whose sign is the orientation towards q.
BernsteinCubic orientation_cubic(const Corners& corner, const MovingPoint& q) {
  const auto edge = [](const MovingPoint& from, const MovingPoint& to) -> MovingVector {
    return {to.start - from.start, to.end - from.end};
  };
  return triple_product(edge(corner[0], corner[1]), edge(corner[0], corner[2]), edge(q, corner[0]));
}

int tally(Orientation orientation, int (&count)[3]) {
  return ++count[orientation == Orientation::positive ? 0 : orientation == Orientation::negative ? 1 : 2];
}

TEST(PointObserver, ASignHoldsAtEveryInstant) {
  Dice dice(1);
  int count[3] = {};
  for (int i = 0; i < 12000; ++i) {
    const Place& place = kPlaces[i % 6];
    const Corners corner = {place(dice.moving(1, 0.4)), place(dice.moving(1, 0.4)),
                            place(dice.moving(1, 0.4))};
    const MovingPoint q = place(dice.moving(1, 0.4));
    const Orientation claimed = orientation(corner, Observer::point(q));
    tally(claimed, count);
    if (claimed != Orientation::uncertain) {
      EXPECT_EQ(claimed, test::exact_class(corner, q)) << "case " << i;
    }
  }
  EXPECT_GT(count[0], 2000);
  EXPECT_GT(count[1], 2000);
  EXPECT_GT(count[2], 1000);
}

TEST(PointObserver, CoefficientsOfOneSignWellAboveTheBoundAreCertain) {
  Dice dice(2);
  int certain = 0;
  for (int i = 0; i < 3000; ++i) {
    const Corners corner = {dice.moving(1, 0.4), dice.moving(1, 0.4), dice.moving(1, 0.4)};
    const MovingPoint q = dice.moving(1, 0.4);
    const BernsteinCubic f = orientation_cubic(corner, q);
    const auto [low, high] = std::minmax({f.c[0], f.c[1], f.c[2], f.c[3]});
    const Orientation found = orientation(corner, Observer::point(q));
    if (low > 1e-12) {
      EXPECT_EQ(found, Orientation::positive);
    }
    if (high < -1e-12) {
      EXPECT_EQ(found, Orientation::negative);
    }
    certain += found != Orientation::uncertain;
  }
  EXPECT_GT(certain, 1000);
}

// Rule error-bound. Mutation: kTripleProductError is zero.
TEST(Orientation, RuleErrorBoundSignsBeneathTheErrorBoundAreUncertain) {
  Dice dice(3);
  int wrong_without_bound = 0, certain = 0;
  for (int i = 0; i < 12000; ++i) {
    const Place& place = kPlaces[i % 6];
    const Corners corner = {place(dice.moving(1, 0.3)), place(dice.moving(1, 0.3)),
                            place(dice.moving(1, 0.3))};
    MovingPoint q = near_plane(corner, dice);
    const Orientation truth = test::exact_class(corner, q);
    const Orientation claimed = orientation(corner, Observer::point(q));
    if (claimed != Orientation::uncertain) {
      ++certain;
      EXPECT_EQ(claimed, truth) << "case " << i;
    }
    BernsteinCubic f = orientation_cubic(corner, q);
    f.error = 0;
    const Orientation naive = test::from_sign(certain_sign(f));
    wrong_without_bound += naive != Orientation::uncertain && naive != truth;
  }
  EXPECT_GT(wrong_without_bound, 100) << "the cases are too tame to need a bound";
  EXPECT_LT(certain, 6000);
}

// Rule error-bound. Mutation: coefficients that are zero count as positive.
TEST(Orientation, RuleErrorBoundTangentTrianglesAreUncertainNearAndFar) {
  for (const double offset : {0.0, 1e3, 1e9, 1e15}) {
    const Vec3 o(offset, -offset, offset);
    const auto still = [&](double x, double y, double z) { return test::still(o + Vec3(x, y, z)); };
    const Corners corner = {still(0, 0, 0), still(8, 0, 0), still(0, 8, 0)};
    EXPECT_EQ(orientation(corner, Observer::point(still(-8, -8, 0))), Orientation::uncertain);
    EXPECT_EQ(orientation(corner, Observer::segment(still(-8, -8, 0), still(-8, 16, 0))),
              Orientation::uncertain);
    EXPECT_EQ(orientation(corner, Observer::point(still(-8, -8, -8))), Orientation::positive);
    EXPECT_EQ(orientation(corner, Observer::point(still(-8, -8, 8))), Orientation::negative);
  }
}

TEST(Orientation, TrianglesWithoutAreaAtAnyTimeAreUncertain) {
  const MovingPoint below = still(0, 0, -1), beside = still(5, 5, -1);
  const Corners line = {still(0, 0, 0), still(1, 0, 0), still(2, 0, 0)};
  const Corners flips = {still(0, 0, 0), still(1, 0, 0), {{0, 1, 0}, {0, -1, 0}}};
  const Corners closes = {still(0, 0, 0), still(1, 0, 0), {{0, 1, 0}, {0, 0, 0}}};
  for (const Corners* corner : {&line, &flips, &closes}) {
    EXPECT_EQ(orientation(*corner, Observer::point(below)), Orientation::uncertain);
    EXPECT_EQ(orientation(*corner, Observer::segment(below, beside)), Orientation::uncertain);
  }
}

TEST(Orientation, NumbersAtTheEndsOfTheRangeAreUncertainNeverWrong) {
  Dice dice(5);
  for (const double scale : {1e-320, 1e-160, 1e-110, 1e-95, 1e99, 1e101, 1e150, 1e300}) {
    for (int i = 0; i < 300; ++i) {
      const Place place{scale, Vec3::Zero()};
      const Corners corner = {place(dice.moving(1, 0.2)), place(dice.moving(1, 0.2)),
                              place(dice.moving(1, 0.2))};
      const MovingPoint q = place(dice.moving(1, 0.2)), tail = place(dice.moving(1, 0.2));
      const Orientation claimed = orientation(corner, Observer::point(q));
      if (claimed != Orientation::uncertain) {
        EXPECT_EQ(claimed, test::exact_class(corner, q)) << scale;
      }
      const Observer segment = Observer::segment(q, tail);
      const Orientation along = orientation(corner, segment);
      if (along != Orientation::uncertain) {
        EXPECT_EQ(test::sampled_sign(corner, segment, 2, 2), along == Orientation::positive ? 1 : -1)
            << scale;
      }
    }
  }
}

TEST(SegmentObserver, ASignHoldsAtEveryPointAndInstant) {
  Dice dice(6);
  int count[3] = {};
  for (int i = 0; i < 3000; ++i) {
    const Place& place = kPlaces[i % 6];
    const double speed = i % 2 == 0 ? 0.1 : 0.5;
    // Segments are long, short or nearly vanishing, and move and turn. Triangles lie beside them and beyond
    // their ends.
    const double length = i % 5 == 0 ? 0.01 : i % 5 == 1 ? 4 : 1;
    const MovingPoint head = dice.moving(0.5, speed);
    const MovingPoint tail = {head.start + dice.in_box(length), head.end + dice.in_box(length)};
    const Vec3 centre = dice.in_box(2), drift = dice.in_box(speed);
    Corners corner;
    for (MovingPoint& p : corner) {
      const MovingPoint local = dice.moving(0.6, speed);
      p = place({centre + local.start, centre + drift + local.end});
    }
    const Observer observer = Observer::segment(place(head), place(tail));
    const Orientation claimed = orientation(corner, observer);
    tally(claimed, count);
    if (claimed == Orientation::uncertain) continue;
    EXPECT_EQ(test::sampled_sign(corner, observer, 6, 4), claimed == Orientation::positive ? 1 : -1)
        << "case " << i;
  }
  EXPECT_GT(count[0], 200);
  EXPECT_GT(count[1], 200);
  EXPECT_GT(count[2], 200);
}

TEST(SegmentObserver, IsNoStricterThanItsTwoEndsWhereTheseSeeTheTriangle) {
  // A triangle that has one sign towards both ends of a segment has that sign from everywhere on the segment.
  Dice dice(7);
  int both = 0;
  for (int i = 0; i < 2000; ++i) {
    const Corners corner = {dice.moving(1, 0.1), dice.moving(1, 0.1), dice.moving(1, 0.1)};
    const MovingPoint head = dice.moving(1, 0.1), tail = dice.moving(1, 0.1);
    const Orientation from_head = orientation(corner, Observer::point(head));
    if (from_head == Orientation::uncertain || orientation(corner, Observer::point(tail)) != from_head)
      continue;
    EXPECT_EQ(orientation(corner, Observer::segment(head, tail)), from_head);
    ++both;
  }
  EXPECT_GT(both, 300);
}

// The squared length of this bone is infinite, so nothing is known about where the triangle projects to. In
// fact it projects to a hundred-thousandth of the bone's length, where the viewing position lies in the
// triangle's plane.
TEST(SegmentObserver, OfALengthWhoseSquareOverflowsProvesNothingWrong) {
  const Observer bone = Observer::segment(still(0, 0, 0), still(1e155, 0, 0));
  const Corners corner = {still(1e150, 0, 0), still(1e150, 1e70, 0), still(1e150, 0, 1e70)};
  ASSERT_EQ(test::sampled_sign(corner, bone, 1, 2), 0);
  EXPECT_EQ(orientation(corner, bone), Orientation::uncertain);
}

TEST(SegmentObserver, OfLengthZeroIsThePoint) {
  Dice dice(8);
  for (int i = 0; i < 500; ++i) {
    const Corners corner = {dice.moving(1, 0.1), dice.moving(1, 0.1), dice.moving(1, 0.1)};
    const MovingPoint q = dice.moving(1, 0.1);
    const Orientation along = orientation(corner, Observer::segment(q, q));
    if (along != Orientation::uncertain) {
      EXPECT_EQ(along, test::exact_class(corner, q));
    }
  }
}

// Rule three-vertices, with the example of the literature: seen from the points nearest to its three corners,
// the dot product is +30, -15 and +7.5. Mutation: viewing_range looks at corner[0] alone, so the triangle is
// positive or negative, depending on which corner comes first.
TEST(SegmentObserver, RuleThreeVerticesAllThreeVerticesDecide) {
  const MovingPoint vertices[3] = {still(0, 1, 1), still(5, 0.25, 4), still(10, -0.5, 1)};
  const Observer bone = Observer::segment(still(0, 0, 0), still(10, 0, 0));
  const int expected[3] = {1, 1, -1};
  for (std::size_t first = 0; first < 3; ++first) {
    const Corners corner = {vertices[first], vertices[(first + 1) % 3], vertices[(first + 2) % 3]};
    const test::ExactView view(corner, bone, 0);
    EXPECT_EQ(view.sign(view.corner[0]), expected[first]) << "a test of one vertex would say so";
    EXPECT_EQ(orientation(corner, bone), Orientation::uncertain);
  }
}

TEST(SegmentObserver, RuleThreeVerticesOneVertexWouldOftenBeWrong) {
  Dice dice(9);
  int mixed = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vec3 centre = dice.in_box(1) + Vec3(0, 0, 1.2);
    Corners corner;
    for (MovingPoint& p : corner) {
      const Vec3 x = centre + dice.in_box(0.8);
      p = {x, x};
    }
    const Observer bone = Observer::segment({{-1, 0, 0}, {-1, 0, 0}}, {{1, 0, 0}, {1, 0, 0}});
    const test::ExactView view(corner, bone, 0);
    const int a = view.sign(view.corner[0]), b = view.sign(view.corner[1]), c = view.sign(view.corner[2]);
    if (a == b && b == c) continue;
    ++mixed;
    EXPECT_EQ(orientation(corner, bone), Orientation::uncertain) << "case " << i;
  }
  EXPECT_GT(mixed, 50);
}

// Triangles that share no vertex, in groups of 1 to 20 triangles: below, at and above multiples of eight.
struct Soup {
  std::vector<Vec3> start, end;
  std::vector<Triangle> triangles;
  std::vector<std::vector<TriangleId>> groups;

  void add(const Corners& corner) {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i) {
      t[i] = VertexId{static_cast<std::int32_t>(start.size())};
      start.push_back(corner[i].start);
      end.push_back(corner[i].end);
    }
    triangles.push_back(t);
  }
  void group() {
    std::int32_t next = 0;
    const auto total = static_cast<std::int32_t>(triangles.size());
    for (int size = 1; next < total; size = size % 20 + 1) {
      groups.emplace_back();
      for (int i = 0; i < size && next < total; ++i) groups.back().push_back(TriangleId{next++});
    }
    std::reverse(groups.begin(), groups.end());
  }
};

// Expects the table and its scalar twin to say the same about every triangle. Returns how many triangles have
// a sign.
int expect_twins(const Soup& soup, const std::function<Observer(std::size_t group)>& observer_of,
                 SegmentTest test = SegmentTest::all_corners) {
  const TriangleMesh mesh(soup.triangles, soup.start.size());
  OrientationTable table(mesh, soup.groups, test);
  OrientationTable one_by_one(mesh, soup.groups, test, Pipeline::published);
  const Motion motion(soup.start, soup.end);
  table.update(motion), one_by_one.update(motion);
  int differences = 0, certain = 0;
  for (std::size_t g = 0; g < soup.groups.size(); ++g) {
    const Observer observer = observer_of(g);
    std::vector<Orientation> classes(soup.groups[g].size(), Orientation{0});
    table.classify(g, observer, classes);
    std::vector<Orientation> again(classes.size(), Orientation{0});
    one_by_one.classify(g, observer, again);
    EXPECT_EQ(again, classes);
    for (std::size_t member = 0; member < classes.size(); ++member) {
      const Triangle& c = mesh.corners(soup.groups[g][member]);
      const Orientation twin = orientation({motion[c[0]], motion[c[1]], motion[c[2]]}, observer, test);
      differences += classes[member] != twin;
      certain += twin != Orientation::uncertain;
      EXPECT_EQ(table.classify(g, member, observer), twin);
      EXPECT_EQ(one_by_one.classify(g, member, observer), twin);
    }
  }
  EXPECT_EQ(differences, 0);
  return certain;
}

TEST(OrientationTable, EqualsItsScalarTwinForEveryTriangleAndLaneCount) {
  Dice dice(10);
  for (const Place& place : kPlaces) {
    Soup soup;
    for (int i = 0; i < 500; ++i)
      soup.add({place(dice.moving(1, 0.3)), place(dice.moving(1, 0.3)), place(dice.moving(1, 0.3))});
    soup.group();
    expect_twins(soup, [&](std::size_t) { return Observer::point(place(dice.moving(1, 0.3))); });
    for (const SegmentTest test : {SegmentTest::all_corners, SegmentTest::first_corner})
      for (const double length : {0.0, 0.01, 1.0, 4.0}) {
        const auto observer = [&](std::size_t) {
          const MovingPoint head = dice.moving(1, 0.3);
          return Observer::segment(place(head),
                                   place({head.start + dice.in_box(length), head.end + dice.in_box(length)}));
        };
        expect_twins(soup, observer, test);
      }
  }
}

// Merging decides with either twin, so both have to agree on triangles at the very bound, too (rule
// fresh-detector).
TEST(OrientationTable, EqualsItsScalarTwinWhereTheErrorBoundDecides) {
  Dice dice(11);
  for (const double height : {3e-14, 6e-14, 1e-13, 3e-13}) {
    Soup soup;
    for (int i = 0; i < 8000; ++i) {
      // The planes of the triangles miss a common point, the observer, by about the error bound.
      const auto tilted = [&](const Vec3& u, const Vec3& v, const Vec3& n) -> Vec3 {
        return dice(-2, 2) * u + dice(-2, 2) * v + dice(0, height) * n;
      };
      const Vec3 u = dice.in_box(1), v = dice.in_box(1), n = u.cross(v);
      Corners corner;
      for (MovingPoint& p : corner) p = {tilted(u, v, n), tilted(u, v, n)};
      soup.add(corner);
    }
    soup.group();
    const int certain = expect_twins(soup, [](std::size_t) {
      return Observer::point({Vec3::Zero(), Vec3::Zero()});
    });
    EXPECT_GT(certain, 50);
    EXPECT_LT(certain, 2000);
    // A segment beside the common point of the planes acts as one point, its nearer end.
    const int along = expect_twins(soup, [](std::size_t) {
      return Observer::segment({Vec3::Zero(), Vec3::Zero()}, {Vec3(1e-15, 0, 0), Vec3(1e-15, 0, 0)});
    });
    EXPECT_GT(along, 20);
    EXPECT_LT(along, 2000);
  }
}

TEST(OrientationTable, ForgetsTheIntervalBefore) {
  Dice dice(12);
  Soup soup;
  for (int i = 0; i < 60; ++i) soup.add({dice.moving(1, 0.3), dice.moving(1, 0.3), dice.moving(1, 0.3)});
  soup.group();
  const TriangleMesh mesh(soup.triangles, soup.start.size());
  const Observer observer = Observer::point(dice.moving(1, 0.3));
  OrientationTable used(mesh, soup.groups), fresh(mesh, soup.groups);
  used.update(Motion(soup.end, soup.start));
  used.update(Motion(soup.start, soup.end));
  fresh.update(Motion(soup.start, soup.end));
  for (std::size_t g = 0; g < soup.groups.size(); ++g) {
    std::vector<Orientation> a(soup.groups[g].size()), b(a.size());
    used.classify(g, observer, a);
    fresh.classify(g, observer, b);
    EXPECT_EQ(a, b);
  }
}

}  // namespace
}  // namespace cscd::radial
