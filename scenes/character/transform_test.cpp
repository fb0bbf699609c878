#include "scenes/character/transform.h"

#include <gtest/gtest.h>
#include <random>

#include "scenes/character/test_characters.h"

namespace cscd::scenes {
namespace {

constexpr double kNearTransform = 1e-12;

Quaternion about_z(double radians) {
  return {std::cos(radians / 2), 0, 0, std::sin(radians / 2)};
}

Transform random_map(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-2, 2);
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  return {{vector(), vector(), vector()}, vector()};
}

void expect_near(const Transform& a, const Transform& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((a.column[i] - b.column[i]).norm(), tolerance);
  EXPECT_LT((a.origin - b.origin).norm(), tolerance);
}

TEST(Transform, ComposesAndInverts) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Transform a = random_map(random), b = random_map(random);
    const Vec3 x(0.3, -1, 2);
    EXPECT_LT((composed(a, b)(x) - a(b(x))).norm(), kNearTransform);
    if (std::abs(a.determinant()) > 0.1) expect_near(composed(inverse(a), a), Transform(), 1e-10);
  }
}

TEST(Transform, OfNoExtentHasNoInverse) {
  EXPECT_FALSE(inverse(from_trs({1, 2, 3}, {}, {0, 1, 1})).finite());
}

TEST(Slerp, TurnsAtConstantSpeedTheShorterWay) {
  for (const double angle : {0.1, 1.0, 3.0}) {
    for (const double s : {0.0, 0.1, 0.25, 1.0 / 3, 0.5, 0.77, 1.0}) {
      const Quaternion want = about_z(s * angle), whole = about_z(angle);
      for (const double sign : {1.0, -1.0}) {  // q and -q are the same rotation
        const Quaternion got = slerp({}, {sign * whole.w, sign * whole.x, sign * whole.y, sign * whole.z}, s);
        EXPECT_NEAR(got.w, want.w, kNearTransform) << angle << " " << s;
        EXPECT_NEAR(got.z, want.z, kNearTransform) << angle << " " << s;
      }
    }
  }
}

TEST(Trs, GiveTheMapBackMirrorsAndShearsToo) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Transform map = random_map(random);
    const Trs parts = trs_of(map);
    Transform rest;
    rest.column = parts.rest;
    expect_near(composed(from_trs(parts.move, parts.rotation, {1, 1, 1}), rest), map, 1e-11);
  }
  const Trs scaled = trs_of(from_trs({1, 2, 3}, about_z(0.5), {2, 3, 4}));
  EXPECT_NEAR(scaled.rest[0].x(), 2, kNearTransform);
  EXPECT_NEAR(scaled.rest[1].y(), 3, kNearTransform);
  EXPECT_NEAR(scaled.rest[2].z(), 4, kNearTransform);
}

TEST(Blend, HasExactEndsAndTurnsBetween) {
  const Transform a = moved_by({1, 0, 0}), b = quarter_turn({3, 0, 0});
  EXPECT_EQ(blend(a, b, 0).origin, a.origin);
  EXPECT_EQ(blend(a, b, 1).column[0], b.column[0]);
  const Transform middle = blend(a, b, 0.5);
  EXPECT_LT((middle.origin - Vec3(2, 0, 0)).norm(), kNearTransform);
  EXPECT_LT((middle.column[0] - Vec3(std::sqrt(0.5), std::sqrt(0.5), 0)).norm(), kNearTransform);
}

}  // namespace
}  // namespace cscd::scenes
