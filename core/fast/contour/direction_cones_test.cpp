#include "core/fast/contour/direction_cones.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace cscd::fast {
namespace {

// A patch of sixteen triangles with random vertices. Triangle l has the vertices l, l + 3 and l + 6, modulo
// sixteen.
struct Thrown {
  PatchLanes lanes;
  Patch patch{};
  Viewpoint from;

  Thrown(std::mt19937& random, float spread) {
    const auto dice = [&] { return static_cast<float>(random() >> 8) * 0x1p-23F - 1; };
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i) {
        from.at[end][i] = 0.1F * dice();
        for (std::size_t l = 0; l < kLanes16; ++l)
          lanes.at[end][i][l] = spread * dice() + (i == static_cast<int>(l % 3) ? 1.0F : 0.0F);
      }
    for (std::size_t l = 0; l < kLanes16; ++l)
      for (std::size_t k = 0; k < 3; ++k)
        patch.corner[k][l] = static_cast<std::uint8_t>((l + 3 * k) % kLanes16);
    patch.lanes = 0xffff;
  }
  // Returns the direction in which a point of a triangle is seen at time t. `weights` are barycentric.
  Vec3 seen(std::size_t lane, const Vec3& weights, double t) const {
    return point(lane, weights, t).normalized();
  }
  // Returns where that point is, from the viewpoint.
  Vec3 point(std::size_t lane, const Vec3& weights, double t) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = patch.corner[k][lane];
        sum[i] += weights[static_cast<int>(k)] * ((1 - t) * static_cast<double>(lanes.at[0][i][v]) +
                                                  t * static_cast<double>(lanes.at[1][i][v]));
      }
      sum[i] -= (1 - t) * static_cast<double>(from.at[0][i]) + t * static_cast<double>(from.at[1][i]);
    }
    return sum;
  }
};

double cosine(const Cone& cone, const Vec3& direction) {
  return cone.axis[0] * direction.x() + cone.axis[1] * direction.y() + cone.axis[2] * direction.z();
}

constexpr float kError = 1e-4F;

Vec3 random_weights(std::mt19937& random) {
  Vec3 w(static_cast<double>(random() % 1000), static_cast<double>(random() % 1000),
         static_cast<double>(random() % 1000));
  if (random() % 3 == 0) w[static_cast<int>(random() % 3)] = 0;
  return (w + Vec3::Constant(1e-9)) / (w.sum() + 3e-9);
}

// Mutations: the end of the interval is ignored; the cone takes the largest cosine.
TEST(DirectionCones, HoldATriangleAtEveryTimeWithRoomForTheError) {
  std::mt19937 random(1);
  std::size_t known = 0;
  for (int round = 0; round < 200; ++round) {
    const Thrown thrown(random, round % 2 == 0 ? 0.3F : 0.9F);
    const Cones cones = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
    const std::optional<Cone> all = cone_of({&thrown.lanes, 1}, thrown.from, kError);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      if ((cones.known >> l & 1) == 0) continue;
      ++known;
      for (int sample = 0; sample < 20; ++sample) {
        const Vec3 seen = thrown.seen(l, random_weights(random), (random() % 101) / 100.0);
        EXPECT_GT(cosine(cones[l], seen), cones[l].cosine + kError / 2);
        if (all) {
          EXPECT_GT(cosine(*all, seen), all->cosine + kError / 2);
        }
      }
    }
  }
  EXPECT_GT(known, 1000u);
}

// Every corner at both ends has the room that the proof gives it: four errors as seen from the viewpoint.
// Mutation: the room is left out of the cone of a triangle, or of that of a whole patch.
TEST(DirectionCones, RuleErrorBoundEveryCornerHasRoomForItsError) {
  std::mt19937 random(9);
  std::size_t whole = 0;
  for (int round = 0; round < 100; ++round) {
    const Thrown thrown(random, 0.3F);
    const Cones cones = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
    const std::optional<Cone> all = cone_of({&thrown.lanes, 1}, thrown.from, kError);
    whole += all.has_value();
    for (std::size_t l = 0; l < kLanes16; ++l)
      for (int k = 0; k < 3; ++k)
        for (const double end : {0.0, 1.0}) {
          const Vec3 to = thrown.point(l, Vec3::Unit(k), end);
          const double room = 4 * static_cast<double>(kError) / to.norm();
          if ((cones.known >> l & 1) != 0) {
            EXPECT_GE(cosine(cones[l], to.normalized()), cones[l].cosine + room);
          }
          if (all) {
            EXPECT_GE(cosine(*all, to.normalized()), all->cosine + room);
          }
        }
  }
  EXPECT_GT(whole, 10u);
}

// A strip is what the second and third corner of a triangle sweep on their way to where they are in other
// lanes. Mutations: the corners of one set of lanes are left out; the first corner is taken too.
TEST(DirectionCones, HoldAStripAtEveryTime) {
  std::mt19937 random(4);
  std::size_t known = 0, narrower = 0;
  for (int round = 0; round < 200; ++round) {
    const Thrown thrown(random, 0.3F);
    Thrown moved = thrown;
    for (int end = 0; end < 2; ++end)
      for (int i = 0; i < 3; ++i)
        moved.lanes.at[end][i] += 0.2F * (thrown.from.at[end][i] - thrown.lanes.at[end][i]) + 0.05F;
    const Cones cones = cones_of_strips(thrown.lanes, moved.lanes, thrown.patch, thrown.from, kError);
    const Cones whole = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      if ((cones.known >> l & 1) == 0) continue;
      ++known;
      narrower += cones[l].cosine > whole[l].cosine;
      for (int sample = 0; sample < 20; ++sample) {
        Vec3 weights = random_weights(random);
        weights[0] = 0;
        if (!(weights.sum() > 0)) continue;
        weights /= weights.sum();
        const double t = (random() % 101) / 100.0, way = (random() % 101) / 100.0;
        // Directions lie in one cone if the points themselves lie in it, seen from the viewpoint.
        const Vec3 one = thrown.point(l, weights, t), other = moved.point(l, weights, t);
        EXPECT_GT(cosine(cones[l], ((1 - way) * one + way * other).normalized()),
                  cones[l].cosine + kError / 2);
      }
    }
  }
  EXPECT_GT(known, 1000u);
  EXPECT_GT(narrower, known / 4);
}

// Compares apart() with the angles in double precision: the cones of all triangles against the cone of each.
TEST(DirectionCones, AreApartOnlyWhereTheSumOfTheirAnglesIsLessThanThatBetweenTheirAxes) {
  std::mt19937 random(2);
  std::size_t are_apart = 0, nearly = 0;
  for (int round = 0; round < 300; ++round) {
    const Thrown thrown(random, 0.4F);
    const Cones cones = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      if ((cones.known >> l & 1) == 0) continue;
      const Cone other = cones[l];
      const Mask16 proven = apart(cones, other);
      for (std::size_t m = 0; m < kLanes16; ++m) {
        if ((cones.known >> m & 1) == 0) {
          EXPECT_EQ(proven >> m & 1, 0);
          continue;
        }
        const Cone cone = cones[m];
        const double between =
            std::acos(std::min(1.0, cosine(other, {cone.axis[0], cone.axis[1], cone.axis[2]})));
        const double room = between - std::acos(static_cast<double>(cone.cosine)) -
                            std::acos(static_cast<double>(other.cosine));
        if (room < 0) {
          EXPECT_EQ(proven >> m & 1, 0) << room;
        }
        if (room > 0.01) {
          EXPECT_EQ(proven >> m & 1, 1) << room;
        }
        are_apart += proven >> m & 1;
        nearly += std::abs(room) < 0.05;
      }
    }
  }
  EXPECT_GT(are_apart, 1000u);
  EXPECT_GT(nearly, 100u);
}

TEST(DirectionCones, AreUnknownAroundAndAtTheViewpoint) {
  std::mt19937 random(3);
  Thrown thrown(random, 0.1F);
  for (int i = 0; i < 3; ++i) {
    thrown.lanes.at[1][i][0] = thrown.from.at[1][i];       // vertex 0 runs into the viewpoint
    thrown.lanes.at[1][i][1] = -thrown.lanes.at[0][i][1];  // vertex 1 goes to the other side
  }
  const Cones cones = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
  for (std::size_t l = 0; l < kLanes16; ++l)
    for (std::size_t k = 0; k < 3; ++k)
      if (thrown.patch.corner[k][l] <= 1) {
        EXPECT_EQ(cones.known >> l & 1, 0) << l;
      }
  EXPECT_FALSE(cone_of({&thrown.lanes, 1}, thrown.from, kError));
}

// Mutation: the sum of the directions is not checked for zero.
TEST(DirectionCones, ThereIsNoneOfDirectionsThatSumToNothing) {
  PatchLanes lanes{};
  for (int end = 0; end < 2; ++end)
    for (std::size_t l = 0; l < kLanes16; ++l) lanes.at[end][0][l] = l % 2 == 0 ? 1 : -1;
  EXPECT_FALSE(cone_of({&lanes, 1}, {}, kError));
}

// Mutations: the last block is cut short; lanes that are apart are taken.
TEST(ConeSet, GivesEveryConeThatIsNotApart) {
  std::mt19937 random(3);
  std::vector<Cone> cones;
  ConeSet set;
  while (cones.size() < 100) {
    const Thrown thrown(random, 0.2F);
    const Cones some = cones_of(thrown.lanes, thrown.patch, thrown.from, kError);
    const std::size_t lane = random() % kLanes16;
    if ((some.known >> lane & 1) == 0) continue;
    cones.push_back(some[lane]);
    set.add(cones.back());
  }
  std::size_t near = 0;
  for (const Cone& other : cones) {
    std::vector<const Cone*> expected;
    for (const Cone& cone : cones) {
      ConeSet alone;
      alone.add(cone);
      alone.for_each_near(other, [&](const Cone&) { expected.push_back(&cone); });
    }
    std::size_t i = 0;
    set.for_each_near(other, [&](const Cone& cone) {
      ASSERT_LT(i, expected.size());
      EXPECT_EQ(cone.axis[0], expected[i++]->axis[0]);
    });
    EXPECT_EQ(i, expected.size());
    near += i;
  }
  EXPECT_GT(near, 200u);
  EXPECT_LT(near, 9000u);
  std::size_t all = 0;
  set.for_each_near(std::nullopt, [&](const Cone&) { ++all; });
  EXPECT_EQ(all, cones.size());
}

}  // namespace
}  // namespace cscd::fast
