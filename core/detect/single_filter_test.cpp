#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>

#include "core/detect/filter_block.h"
#include "core/elementary/catalogue.h"
#include "core/elementary/question/test_filter.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// Returns the places of two triangles that the scalar functions of the filter keep.
CarriedPlaces kept(const TriangleMesh& mesh, const Motion& motion, const TrianglePair& pair) {
  const auto drops = [](const auto& query) {
    return never_coplanar(query) || test::never_meet_in_plane(query);
  };
  unsigned places = 0;
  for (std::size_t k = 0; k < 15; ++k) {
    const FeaturePair features = carried(mesh, pair, k);
    const bool drop = features.kind == FeaturePair::Kind::vertex_face
                          ? drops(vertex_face(mesh, motion, VertexId{features.a}, TriangleId{features.b}))
                          : drops(edge_edge(mesh, motion, EdgeId{features.a}, EdgeId{features.b}));
    places |= static_cast<unsigned>(!drop) << k;
  }
  return static_cast<CarriedPlaces>(places);
}

using Six = std::array<MovingPoint, 6>;  // corners of one triangle, then of the other

struct Tally {
  int none = 0, some = 0;
};

// Asks for `count` pairs of triangles that make() draws. Their corners are numbered in any order. Half of the
// calls are about all places, the other half about one place. Whatever is dropped is dropped by the scalar
// functions too, or touches at no time by the exact test. If `alike`, the scalar functions keep the same.
template <class Make>
Tally look(int count, const Make& make, bool alike = false) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  Tally tally;
  std::mt19937_64 random(3);
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    const Six points = make(random);
    std::array<std::int32_t, 6> number = {0, 1, 2, 3, 4, 5};
    std::shuffle(number.begin(), number.end(), random);
    std::vector<Vec3> start(6), end(6);
    for (std::size_t v = 0; v < 6; ++v) {
      const auto at = static_cast<std::size_t>(number[v]);
      start[at] = points[v].start, end[at] = points[v].end;
    }
    const TriangleMesh mesh(
        {test::corners(number[0], number[1], number[2]), test::corners(number[3], number[4], number[5])}, 6);
    const Motion motion(start, end);
    const TrianglePair pair{TriangleId{0}, TriangleId{1}};
    const CarriedPlaces places = i % 2 ? kAllCarried : static_cast<CarriedPlaces>(1 << random() % 15);
    const auto scalar = static_cast<CarriedPlaces>(places & kept(mesh, motion, pair));
    const CarriedPlaces seen =
        not_filtered_when_coplanar(motion, mesh.corners(pair.a), mesh.corners(pair.b), places, 1);
    if (alike) {
      EXPECT_EQ(seen, scalar) << "interval " << i;
    }
    EXPECT_EQ(seen & ~places, 0);
    for (std::size_t k = 0; k < 15; ++k)
      if ((scalar & ~seen) >> k & 1) {
        EXPECT_NE(ask(exact, mesh, motion, carried(mesh, pair, k)).verdict, Verdict::contact)
            << "interval " << i << ", place " << k;
      }
    tally.none += seen == 0;
    tally.some += seen != 0;
  }
  return tally;
}

Vec3 any(std::mt19937_64& random, double size = 1) {
  std::uniform_real_distribution<double> unit(-size, size);
  return {unit(random), unit(random), unit(random)};
}

// Returns the points in another coordinate frame, so that no coordinate is more exact than others.
Six turned(std::mt19937_64& random, Six six) {
  const Vec3 shift = any(random, 10), x = any(random), y = any(random), z = x.cross(y);
  for (auto& point : six)
    for (Vec3* p : {&point.start, &point.end}) *p = Vec3(shift + p->x() * x + p->y() * y + p->z() * z);
  return six;
}

// Triangles lie near one another and move by about a third of their size.
TEST(CarriedLook, DropsWhatTouchesAtNoTime) {
  const Vec3 far(12, -7, 31);
  const Tally tally = look(20'000, [&](std::mt19937_64& random) {
    Six six;
    for (auto& [start, end] : six) start = far + any(random), end = start + any(random, 0.3);
    return six;
  });
  EXPECT_GT(tally.none, 5000);
  EXPECT_GT(tally.some, 3000);
}

// Points lie within a few of the bounds of single and of double precision from a
// place where the answer changes.
class NearlyTouching : public testing::TestWithParam<double> {
 protected:
  const double off = GetParam();
};
INSTANTIATE_TEST_SUITE_P(CarriedLook, NearlyTouching,
                         testing::Values(0.0, 1e-16, 1e-13, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4));

TEST_P(NearlyTouching, InOnePlane) {
  look(3000, [&](std::mt19937_64& random) {
    Six six;
    for (std::size_t v = 0; v < 6; ++v) {
      auto& [start, end] = six[v];
      start = any(random), end = start + any(random, 0.1);
      start.z() *= off, end.z() *= v % 2 ? off : -off;
    }
    return turned(random, six);
  });
}
TEST_P(NearlyTouching, InOnePlaneAtFirst) {
  look(3000, [&](std::mt19937_64& random) {
    Six six;
    for (std::size_t v = 0; v < 6; ++v) {
      auto& [start, end] = six[v];
      start = any(random), end = start;
      start.z() *= off, end.z() = v < 3 ? start.z() : -0.1;
    }
    return turned(random, six);
  });
}
TEST_P(NearlyTouching, InOneLine) {
  look(3000, [&](std::mt19937_64& random) {
    Six six;
    for (std::size_t v = 0; v < 6; ++v) {
      const Vec3 along = any(random).x() * Vec3(1, 0.3, 0.1);
      six[v] = {along + any(random, v ? off : 1), along + any(random, v ? off : 1)};
    }
    return six;
  });
}
// A small triangle, and a long one in its plane with a corner on it. Where nothing is added, all points are
// on a grid, so that they lie in one plane exactly, and most of these triangles touch.
TEST_P(NearlyTouching, SmallBesideLong) {
  look(3000, [&](std::mt19937_64& random) {
    Six six;
    const auto on_grid = [](const Vec3& x, double step) { return Vec3((x / step).array().round() * step); };
    const Vec3 at = on_grid(any(random), 0x1p-24), p = on_grid(any(random, 1e-4), 0x1p-24),
               q = on_grid(any(random, 1e-4), 0x1p-24);
    const Vec3 small[3] = {at, at + p, at + q};
    for (std::size_t v = 0; v < 6; ++v) {
      const double reach = v == 0 ? 1e4 : 0.3;
      const Vec3 factor = on_grid(Vec3(reach * (Vec3::Constant(0.5) + any(random))), 0x1p-4);
      const Vec3 in_plane = factor.x() * p + factor.y() * q;
      const Vec3 x = v < 3 ? Vec3(at + in_plane + any(random, 1e-4 * off)) : small[v - 3];
      six[v] = {x, x};
    }
    return six;
  });
}
// Borders pass one another, straight or at an angle.
TEST_P(NearlyTouching, AtBorders) {
  int count = 0;
  look(6000, [&](std::mt19937_64& random) {
    constexpr double at[6][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1.2, 1}, {2, 0.5}};
    const Vec3 across = ++count % 3 ? Vec3(0, 0, 0.1) : Vec3(0.03, -0.02, 0.1);
    Six six;
    for (std::size_t v = 0; v < 6; ++v) {
      const Vec3 place(at[v][0], at[v][1], 0), move = v < 3 ? Vec3(Vec3::Zero()) : across;
      six[v] = {place + any(random, off) + move, place + any(random, off) - move};
    }
    return turned(random, six);
  });
}

// Sizes that underflow or overflow in single precision are left to doubles. In the range where projections
// overflow but their bounds do not, a look would be wrong about few triangles, so many triangles are tried.
TEST(CarriedLook, LeavesToDoublesWhatIsBeyondItsRange) {
  for (const double scale : {1e-160, 1e-40, 1e-30, 1e-20, 1e-12, 1e-9, 3e-10, 1e-8, 1e8,  3e8,
                             3e9,    1e10,  1e12,  1e13,  1e14,  1e16, 1e18,  1e30, 1e40, 1e160}) {
    SCOPED_TRACE(scale);
    const int count = scale < 1e-10 || scale > 1e20 ? 500 : 10'000;
    look(
        count,
        [&](std::mt19937_64& random) {
          Six six;
          for (auto& [start, end] : six) start = scale * any(random), end = scale * any(random);
          return six;
        },
        scale < 1e-10 || scale > 1e10);
  }
  look(500, [&](std::mt19937_64& random) {
    Six six;
    for (std::size_t v = 0; v < 6; ++v) {
      const double scale = v == 2 ? 1e25 : v == 4 ? 1e-12 : 1;
      six[v] = {scale * any(random), scale * any(random)};
    }
    return six;
  });
}

// Intervals that are cut short at the time of a contact, or at any other time. Far ends make the differences
// that are cut as inexact as they can be. Mutation: the interval is cut at nine tenths of `last`.
TEST(CutShort, KeepsWhatTouchesUntilThen) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  std::mt19937_64 random(7);
  std::size_t kept = 0, dropped = 0, later = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double speed = i % 2 ? 0.3 : 3e7, size = i % 2 ? 1 : 1e-3;
    std::vector<Vec3> start(6), end(6);
    for (std::size_t v = 0; v < 6; ++v) start[v] = any(random, size), end[v] = start[v] + any(random, speed);
    const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
    const Motion motion(start, end);
    const TrianglePair pair{TriangleId{0}, TriangleId{1}};
    std::array<double, 15> time;
    for (std::size_t k = 0; k < 15; ++k) {
      const Answer answer = ask(exact, mesh, motion, carried(mesh, pair, k));
      time[k] = answer.verdict == Verdict::contact ? answer.time : 2;
    }
    for (std::size_t cut = 0; cut < 15; ++cut) {
      if (time[cut] >= 1) continue;
      const double last = std::min(1.0, time[cut] + 0x1p-47);
      const CarriedPlaces left =
          not_filtered_when_coplanar(motion, mesh.corners(pair.a), mesh.corners(pair.b), kAllCarried, last);
      for (std::size_t k = 0; k < 15; ++k) {
        const bool is_kept = left >> k & 1;
        ASSERT_TRUE(is_kept || time[k] > last) << i << " " << k << " until " << last;
        kept += is_kept, dropped += !is_kept, later += !is_kept && time[k] <= 1;
      }
    }
  }
  EXPECT_GT(dropped, kept);
  EXPECT_GT(later, 1000u) << "what touches later is dropped";
}

// Triangles pass close by one another, and some meet. Whatever is dropped touches at no time, by the exact
// test, and most of what does not touch is dropped. Mutations: the part with roots ends shortly behind its
// beginning; of the three descents from an end, only the one to the other end is looked at.
TEST(WhenCoplanar, DropsMostOfWhatDoesNotTouchAndNothingThatDoes) {
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  std::mt19937_64 random(11);
  std::size_t touching = 0, in_vain = 0, in_vain_before = 0;
  for (int i = 0; i < 60'000; ++i) {
    const double speed = i % 3 ? 0.5 : 3, size = std::ldexp(1, i % 7 - 3), flat = std::ldexp(1, -(i % 25));
    std::vector<Vec3> start(6), end(6);
    for (std::size_t v = 0; v < 6; ++v) {
      start[v] = any(random, size), end[v] = start[v] + any(random, speed * size);
      start[v].z() *= flat, end[v].z() *= flat;
    }
    const bool at_border = i % 2;
    if (at_border) {  // the last vertex meets an edge of the other triangle, slowly if both are flat
      const double time = any(random).x() / 2 + 0.5, along = any(random).x() / 2 + 0.5;
      const auto at = [&](std::size_t v) { return Vec3((1 - time) * start[v] + time * end[v]); };
      const Vec3 met = (1 - along) * at(0) + along * at(1), moved = end[5] - start[5];
      start[5] = met - time * moved, end[5] = met + (1 - time) * moved;
    }
    const TriangleMesh mesh({test::corners(0, 1, 2), test::corners(3, 4, 5)}, 6);
    const Motion motion(start, end);
    const TrianglePair pair{TriangleId{0}, TriangleId{1}};
    const double last = i % 4 ? 1 : 0.75;
    const Triangle &a = mesh.corners(pair.a), &b = mesh.corners(pair.b);
    const CarriedPlaces left = not_filtered_when_coplanar(motion, a, b, kAllCarried, last);
    const CarriedPlaces before = not_filtered(motion, a, b, kAllCarried);
    for (std::size_t k = 0; k < 15; ++k) {
      const Answer answer = ask(exact, mesh, motion, carried(mesh, pair, k));
      const bool touches = answer.verdict == Verdict::contact && answer.time <= last, is_kept = left >> k & 1;
      ASSERT_TRUE(is_kept || !touches) << i << " " << k;
      touching += touches;
      if (touches || at_border || flat < 0x1p-8) continue;  // single precision knows little of what is flat
      in_vain += is_kept, in_vain_before += before >> k & 1;
    }
  }
  EXPECT_GT(touching, 20'000u);
  EXPECT_LT(in_vain, in_vain_before / 2);
}

}  // namespace
}  // namespace cscd
