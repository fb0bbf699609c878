#include "core/fast/contour/ray.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace cscd::fast {
namespace {

struct Fixture {
  PatchLanes lanes{};
  Patch patch{};
  Viewpoint from{};
};

// Makes a patch of random vertices and triangles, and a viewpoint. With `around`, the vertices lie round the
// viewpoint, and every third vertex lies near the ray. Without, all vertices lie round one random point.
Fixture thrown(std::mt19937& random, const float (&through)[3], bool around) {
  const auto dice = [&] { return static_cast<float>(random() >> 8) * 0x1p-23F - 1; };
  Fixture f;
  for (int i = 0; i < 3; ++i) f.from.at[0][i] = 0.2F * dice();
  const float middle[3] = {dice(), dice(), dice()};
  for (std::size_t l = 0; l < 15; ++l)
    for (int i = 0; i < 3; ++i)
      f.lanes.at[0][i][l] = !around      ? middle[i] + 0.3F * dice()
                            : l % 3 == 0 ? through[i] + 0.2F * dice() * dice()
                                         : dice();
  for (std::size_t l = 0; l < kLanes16; ++l)
    for (std::size_t k = 0; k < 3; ++k) f.patch.corner[k][l] = static_cast<std::uint8_t>(random() % 15);
  f.patch.lanes = 0xffff;
  return f;
}

// Mutations: the error bound is zero; the sign is reversed; one edge is ignored; may_cross tests one side
// alone.
TEST(Ray, CrossesWhatDoublePrecisionSaysItDoesWithinTheErrorOfCoordinates) {
  std::mt19937 random(7);
  constexpr float kError = 1e-5F;
  std::size_t crossed = 0, not_crossed = 0, undecided = 0, rejected = 0;
  for (int round = 0; round < 3000; ++round) {
    const float through[3] = {0.7F, 0.1F * static_cast<float>(round % 7), -0.4F};
    Fixture f = thrown(random, through, round % 2 == 0);
    const Ray ray(f.from, through, kError);
    const Ray::Crossed out = ray.crossed(f.lanes, f.patch);
    const bool may = ray.may_cross(f.lanes);
    rejected += !may;
    const auto at = [&](std::size_t v, double wobble) {
      Vec3 p;
      for (int i = 0; i < 3; ++i)
        p[i] = static_cast<double>(f.lanes.at[0][i][v]) - static_cast<double>(f.from.at[0][i]) +
               wobble * static_cast<double>(kError) * (random() % 2 == 0 ? 1 : -1);
      return p;
    };
    Vec3 along;
    for (int i = 0; i < 3; ++i)
      along[i] = static_cast<double>(through[i]) - static_cast<double>(f.from.at[0][i]);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      const std::size_t a = f.patch.corner[0][l], b = f.patch.corner[1][l], c = f.patch.corner[2][l];
      if (a == b || b == c || c == a || !(at(a, 0).dot(at(b, 0).cross(at(c, 0))) > 1e-3)) continue;
      EXPECT_FALSE((out.certainly & out.certainly_not) >> l & 1);
      // The true corners may be anywhere within the error.
      for (int sample = 0; sample < 4; ++sample) {
        const Vec3 p = at(a, 1), q = at(b, 1), r = at(c, 1);
        const bool truth =
            along.dot(p.cross(q)) > 0 && along.dot(q.cross(r)) > 0 && along.dot(r.cross(p)) > 0;
        if (out.certainly >> l & 1) {
          EXPECT_TRUE(truth);
        }
        if (out.certainly_not >> l & 1) {
          EXPECT_FALSE(truth);
        }
        if (truth) {
          EXPECT_TRUE(may);
        }
      }
      crossed += out.certainly >> l & 1;
      not_crossed += out.certainly_not >> l & 1;
      undecided += ((out.certainly | out.certainly_not) >> l & 1) == 0;
    }
  }
  EXPECT_GT(crossed, 300u);
  EXPECT_GT(not_crossed, 3000u);
  EXPECT_LT(undecided, crossed / 10);
  EXPECT_GT(rejected, 300u);
}

// A triangle across the ray, whose corners are `away` errors of the ray (ray.cpp) from it. By the bound of
// the proof the ray crosses it certainly only beyond about 6 errors. Mutation: the bound is half of that.
TEST(Ray, RuleErrorBoundCrossesNothingThatIsAsSmallAsTheError) {
  constexpr float kError = 1e-4F;
  const float through[3] = {1, 0, 0};
  for (const auto& [away, decides] : {std::pair(4.5F, false), {12.0F, true}})
    for (const bool turned : {false, true}) {
      Fixture f;
      for (std::size_t l = 0; l < kLanes16; ++l) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(l % 3) / 3;
        const float size = away * 20 * kError;
        f.lanes.at[0][0][l] = 1;
        f.lanes.at[0][1][l] = size * static_cast<float>(std::cos(angle));
        f.lanes.at[0][2][l] = size * static_cast<float>(std::sin(angle));
        for (std::size_t k = 0; k < 3; ++k)
          f.patch.corner[k][l] = static_cast<std::uint8_t>(turned ? 2 - k : k);
      }
      const Ray::Crossed out = Ray(f.from, through, kError).crossed(f.lanes, f.patch);
      EXPECT_EQ(out.certainly, decides && !turned ? 0xffff : 0) << away;
      EXPECT_EQ(out.certainly_not, decides && turned ? 0xffff : 0) << away;
    }
}

// Mutation: may_cross ignores the error.
TEST(Ray, MayCrossWhatHasACornerOnIt) {
  std::mt19937 random(8);
  const auto dice = [&] { return static_cast<float>(random() >> 8) * 0x1p-23F - 1; };
  const float through[3] = {0.6F, 0.1F, 0.8F};
  const Ray ray({}, through, 1e-6F);
  for (int round = 0; round < 100; ++round) {
    const float to[3] = {dice(), dice(), dice()};
    PatchLanes lanes{};
    for (std::size_t l = 0; l < kLanes16; ++l)
      for (int i = 0; i < 3; ++i) lanes.at[0][i][l] = through[i] + (l == 5 ? 0 : to[i]);
    EXPECT_TRUE(ray.may_cross(lanes));
  }
}

TEST(Ray, LiesInTheConeOfWhatItGoesThrough) {
  const Viewpoint from{};
  const Ray ray(from, {0.6F, 0, 0.8F}, 1e-6F);
  const auto cone = [](float x, float z, float cosine) { return Cone{{x, 0, z}, cosine, 0}; };
  EXPECT_FALSE(ray.outside(cone(0.6F, 0.8F, 0.999F)));
  EXPECT_FALSE(ray.outside(cone(0.8F, 0.6F, 0.9599F)));
  EXPECT_TRUE(ray.outside(cone(0.8F, 0.6F, 0.9601F)));
  EXPECT_TRUE(ray.outside(cone(-0.6F, -0.8F, 0.2F)));
  EXPECT_FALSE(Ray(from, {0, 1e-25F, 0}, 1e-6F).outside(cone(-0.6F, -0.8F, 0.2F)));
}

}  // namespace
}  // namespace cscd::fast
