#include "core/fast/classify/patch_lanes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/fast/classify/test_patches.h"

namespace cscd::fast {

namespace {

TEST(PatchLanes, LoadBringsEveryVertexToItsLane) {
  const test::Patches scene(0.1, 1, {0, 0, 0}, 1, 1);
  for (const Patch& patch : scene.tree.patches) {
    const PatchLanes lanes = load(scene.local.records(), patch.vertex);
    for (std::size_t l = 0; l < kLanes16; ++l)
      for (std::size_t i = 0; i < 3; ++i) {
        const float* at = scene.local.records()[static_cast<std::size_t>(patch.vertex[l])].at;
        EXPECT_EQ(lanes.at[0][i][l], at[i]);
        EXPECT_EQ(lanes.at[1][i][l], at[4 + i]);
      }
  }
}

// Rule error-bound. Every certified sign is the exact sign, far from the origin and in any unit, and nearly
// all signs are certified. Mutations: the error bound is zero; positions are converted to float without the
// shift; corner 1 takes the place of corner 0; the middle coefficients are ignored.
TEST(PatchLanes, RuleErrorBoundCertifiedSignsAreExact) {
  std::size_t certified = 0, all = 0, negative = 0;
  int turn = 0;
  for (const test::Patches& scene : test::patches())
    for (std::size_t p = 0; p < scene.tree.patches.size(); p += 11) {
      const Patch& patch = scene.tree.patches[p];
      const PatchLanes lanes = load(scene.local.records(), patch.vertex);
      // Viewpoints inside the body, on the surface, and outside.
      Viewpoint from;
      MovingPoint q;
      for (std::size_t end = 0; end < 2; ++end)
        for (std::size_t i = 0; i < 3; ++i) {
          const float vertex = lanes.at[end][i][0];
          const float offset[3] = {0, i == 0 ? 0.0F : -0.05F, 0.7F};
          from.at[end][i] = std::round((vertex + offset[turn % 3]) * 0x1p12F) * 0x1p-12F;
          const double world =
              scene.shift[static_cast<Eigen::Index>(i)] + scene.unit * static_cast<double>(from.at[end][i]);
          (end == 0 ? q.start : q.end)[static_cast<Eigen::Index>(i)] = world;
          // Skip viewpoints that are not exact in the world: the exact test would take another point.
          if (mpq_class(world) != mpq_class(scene.shift[static_cast<Eigen::Index>(i)]) +
                                      mpq_class(scene.unit) * mpq_class(from.at[end][i]))
            from.at[end][i] = std::numeric_limits<float>::quiet_NaN();
        }
      ++turn;
      const Signs signs = orientation(lanes, patch, from, scene.local.error());
      for (std::size_t l = 0; l < kLanes16; ++l) {
        const Triangle& c = scene.mesh.corners(scene.tree.triangles[p][l]);
        const Motion motion = scene.motion();
        const MovingPoint corner[3] = {motion[c[0]], motion[c[1]], motion[c[2]]};
        const radial::Orientation truth = test::exact_class(corner, q);
        EXPECT_TRUE(!(signs.positive >> l & 1) || truth == radial::Orientation::positive);
        EXPECT_TRUE(!(signs.negative >> l & 1) || truth == radial::Orientation::negative);
        certified += (signs.positive | signs.negative) >> l & 1;
        negative += signs.negative >> l & 1;
        all += truth != radial::Orientation::uncertain;
      }
    }
  EXPECT_GT(negative, 50u);
  EXPECT_GT(certified, all / 2);
}

// Nothing overflows with positions and observers as far away as they are allowed to be, whether triangles are
// large or small. Mutation: kMostWeight is 1e14.
TEST(PatchLanes, CertifiedSignsAreExactTowardsTheFarthestObservers) {
  constexpr float kFarthest = 1e9F;  // of local positions
  std::mt19937 random(3);
  std::uniform_real_distribution<float> digits(-1, 1), magnitude(0, 7);
  std::size_t certified = 0;
  for (int round = 0; round < 400; ++round) {
    PatchLanes lanes;
    Viewpoint from;
    Patch patch{};
    const float scattered = kFarthest * std::pow(10.0F, -magnitude(random));
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t i = 0; i < 3; ++i) {
        from.at[end][i] = FollowingPoint::kMostWeight * kFarthest * digits(random);
        const float middle = kFarthest * digits(random) * (round % 2 == 0 ? 1.0F : 0.0F);
        for (std::size_t l = 0; l < kLanes16; ++l)
          lanes.at[end][i][l] = std::clamp(middle + scattered * digits(random), -kFarthest, kFarthest);
      }
    for (std::size_t l = 0; l < kLanes16; ++l) {
      patch.corner[0][l] = static_cast<std::uint8_t>(l);
      patch.corner[1][l] = static_cast<std::uint8_t>((l + 5) % kLanes16);
      patch.corner[2][l] = static_cast<std::uint8_t>((l + 11) % kLanes16);
    }
    if (round % 4 < 2)  // at rest; in motion certain signs are rare
      for (std::size_t i = 0; i < 3; ++i) lanes.at[1][i] = lanes.at[0][i], from.at[1][i] = from.at[0][i];
    const float error = 0x1.1p-24F * kFarthest;
    if (round % 8 < 4) from.reach = reach_of(from, error);
    const Signs signs = orientation(lanes, patch, from, error);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      const auto point = [](auto&& at) {  // (end, axis) -> float
        return MovingPoint{Vec3(at(0, 0), at(0, 1), at(0, 2)), Vec3(at(1, 0), at(1, 1), at(1, 2))};
      };
      MovingPoint corner[3];
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = point([&](int end, int i) { return lanes.at[end][i][patch.corner[k][l]]; });
      const radial::Orientation truth =
          test::exact_class(corner, point([&](int end, int i) { return from.at[end][i]; }));
      EXPECT_TRUE(!(signs.positive >> l & 1) || truth == radial::Orientation::positive);
      EXPECT_TRUE(!(signs.negative >> l & 1) || truth == radial::Orientation::negative);
      certified += (signs.positive | signs.negative) >> l & 1;
    }
  }
  EXPECT_GT(certified, 500u);
}

// Returns the sign of one triangle, computed by plain scalar code.
int scalar_sign(const float (&x)[3][2][3], const Viewpoint& from, float error) {
  float a[2][3], b[2][3], c[2][3], n[3][3], most[3] = {};
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) {
      a[end][i] = x[1][end][i] - x[0][end][i];
      b[end][i] = x[2][end][i] - x[0][end][i];
      c[end][i] = x[0][end][i] - from.at[end][i];
      most[0] = std::max(most[0], std::abs(a[end][i]));
      most[1] = std::max(most[1], std::abs(b[end][i]));
      most[2] = std::max(most[2], std::abs(c[end][i]));
    }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    n[0][i] = a[0][j] * b[0][k] - a[0][k] * b[0][j];
    n[1][i] = (a[0][j] * b[1][k] - a[0][k] * b[1][j]) + (a[1][j] * b[0][k] - a[1][k] * b[0][j]);
    n[2][i] = a[1][j] * b[1][k] - a[1][k] * b[1][j];
  }
  const auto dot = [&](int m, int end) {
    return n[m][0] * c[end][0] + n[m][1] * c[end][1] + n[m][2] * c[end][2];
  };
  for (float& m : most) m += 2 * error;
  const float area = most[0] * most[1], volume = area * most[2];
  const float bound = 12.1F * error * (area + (most[0] + most[1]) * most[2]) + 68 * 0x1p-24F * volume;
  const float value[4] = {dot(0, 0), dot(1, 0) + dot(0, 1), dot(1, 1) + dot(2, 0), dot(2, 1)};
  if (!(area > 1e-30F && volume > 1e-30F)) return 0;
  bool above = true, below = true;
  for (int k = 0; k < 4; ++k) {
    const float limit = k == 0 || k == 3 ? bound : 3 * bound;
    above = above && value[k] > limit;
    below = below && value[k] < -limit;
  }
  return above ? 1 : below ? -1 : 0;
}

// The cases have errors so large that bounds decide, or lengths so small that nothing is known. Signs are the
// same whether or not the viewpoint's reach is known. Mutations: the bound takes the smallest component for
// the largest; the bound for a whole patch passes unknown signs as positive.
TEST(PatchLanes, OrientationIsWhatScalarCodeSays) {
  struct Case {
    float size, error;  // scale of all lengths; error in local units
  };
  const Viewpoint centre = {{{0.5F, 0.01F, 0.02F}, {0.52F, 0.05F, -0.01F}}};
  for (const test::Patches& scene : test::patches())
    for (const Case& with :
         {Case{1, scene.local.error()}, Case{1, 1e-3F}, Case{0x1p-37F, scene.local.error()}}) {
      const float error = with.size * with.error;
      std::size_t certain = 0, uncertain = 0, whole = 0;
      Viewpoint from = centre;
      for (auto& end : from.at)
        for (float& component : end) component *= with.size;
      Viewpoint reached = from;
      reached.reach = reach_of(from, error);
      for (const Patch& patch : scene.tree.patches) {
        PatchLanes lanes = load(scene.local.records(), patch.vertex);
        for (auto& end : lanes.at)
          for (Float16& component : end) component *= with.size;
        const Signs signs = orientation(lanes, patch, from, error);
        const Signs same = orientation(lanes, patch, reached, error);
        EXPECT_EQ(same.positive, signs.positive);
        EXPECT_EQ(same.negative, signs.negative);
        whole += same.positive == 0xffff;
        for (std::size_t l = 0; l < kLanes16; ++l) {
          float x[3][2][3];
          for (std::size_t k = 0; k < 3; ++k)
            for (int end = 0; end < 2; ++end)
              for (int i = 0; i < 3; ++i) x[k][end][i] = lanes.at[end][i][patch.corner[k][l]];
          const int sign = scalar_sign(x, from, error);
          EXPECT_EQ(signs.positive >> l & 1, sign > 0);
          EXPECT_EQ(signs.negative >> l & 1, sign < 0);
          ++(sign == 0 ? uncertain : certain);
        }
      }
      EXPECT_GT(uncertain, 0u);
      EXPECT_EQ(certain > 0, with.size == 1);
      // With an error of a thousandth, it depends on the cut into patches whether any is certain throughout.
      if (with.size != 1) {
        EXPECT_EQ(whole, 0u);
      } else if (with.error < 1e-3F) {
        EXPECT_GT(whole, 0u);
      }
    }
}

// Planes and heights that are certified at a distance keep it at many times of the interval.
// Mutations: no margin; no height; edges, or distances from the viewpoint, at the start alone; the middle
// coefficients without their factor of three.
TEST(PatchLanes, AtADistancePlanesAndHeightsKeepIt) {
  std::size_t tall = 0, not_tall = 0, with_sign = 0;
  int turn = 0;
  for (const test::Patches& scene : test::patches()) {
    if (scene.shift.norm() > 10)
      continue;  // the heights below are computed in doubles, from rounded positions
    for (std::size_t p = 0; p < scene.tree.patches.size(); p += 3) {
      const Patch& patch = scene.tree.patches[p];
      const PatchLanes lanes = load(scene.local.records(), patch.vertex);
      Viewpoint from;
      for (std::size_t end = 0; end < 2; ++end)
        for (std::size_t i = 0; i < 3; ++i)
          from.at[end][i] =
              lanes.at[end][i][turn % 5] + (i == 0 ? 0.01F : -0.03F) * static_cast<float>(turn % 3);
      const auto at = [&](std::size_t place, double t) {
        Vec3 out;
        for (std::size_t i = 0; i < 3; ++i)
          out[static_cast<Eigen::Index>(i)] =
              (1 - t) * static_cast<double>(lanes.at[0][i][place] - from.at[0][i]) +
              t * static_cast<double>(lanes.at[1][i][place] - from.at[1][i]);
        return out;
      };
      const float height = 0.002F * static_cast<float>(turn % 7),
                  margin = height * static_cast<float>(turn % 4) / 3;
      ++turn;
      const Viewpoint* const viewpoints[kCovers] = {&from};
      DistantSigns found;
      orientations_at_distance(lanes, patch, viewpoints, scene.local.error(), margin, height, found);
      for_each_lane(patch.lanes, [&](std::size_t l) {
        const bool is_tall = found.tall[0] >> l & 1, positive = found.signs[0].positive >> l & 1,
                   negative = found.signs[0].negative >> l & 1;
        EXPECT_TRUE(!is_tall || positive);
        tall += is_tall, not_tall += !is_tall, with_sign += positive || negative;
        for (int k = 0; k <= 16; ++k) {
          const Vec3 x[3] = {at(patch.corner[0][l], k / 16.0), at(patch.corner[1][l], k / 16.0),
                             at(patch.corner[2][l], k / 16.0)};
          const Vec3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
          const double volume = normal.dot(x[0]), plane = volume / normal.norm();
          EXPECT_GT(positive ? plane : HUGE_VAL, margin);
          EXPECT_LT(negative ? plane : -HUGE_VAL, -margin);
          if (!is_tall) continue;
          EXPECT_GT(plane, height);
          for (int u = 0; u < 3; ++u) {
            const Vec3 &v = x[(u + 1) % 3], &w = x[(u + 2) % 3];
            EXPECT_GT(volume / v.cross(w).norm(), height);
            EXPECT_GT(volume / (v - x[u]).cross(w).norm(), height);
          }
        }
      });
    }
  }
  EXPECT_GT(tall, 200u);
  EXPECT_GT(not_tall, 300u);
  EXPECT_GT(with_sign, tall);
}

// A viewpoint stands where double precision places its observer. An observer that stands off its vertices
// does so by the same at both ends. Mutations: an axis or an end is taken for another; the end of the
// interval has an offset of its own.
TEST(Viewpoint, StandsWhereItsObserverIs) {
  int stand_off = 0;
  for (const test::Patches& body : test::patches()) {
    FollowingPoint point;
    for (int i = 0; i < 5; ++i) point.add(VertexId{7 * i + 1}, i == 0 ? 0.6F : 0.1F);
    for (const float height : {0.0F, -0.75F}) {
      point.stand_off(height);
      stand_off += point.stands_off();
      const Viewpoint viewpoint = placed(point, body.local.records());
      std::vector<Vec3> corners;
      for (const VertexId v : point.vertices()) corners.push_back((body.start[+v] - body.shift) / body.unit);
      const Vec3 offset = point.offset(corners);
      for (int end = 0; end < 2; ++end) {
        Vec3 expected = offset;
        for (std::size_t i = 0; i < 5; ++i) {
          const auto& positions = end == 0 ? body.start : body.end;
          const Vec3 at = (positions[+point.vertices()[i]] - body.shift) / body.unit;
          expected += static_cast<double>(point.weights()[i]) * at;
        }
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(static_cast<double>(viewpoint.at[end][k]), expected[k], 1e-5) << end << " " << k;
      }
    }
  }
  EXPECT_EQ(stand_off, 4);
}

// The reach is more than the sum of the largest coordinates of a vertex and of the viewpoint, and twice the
// error of a vertex. Mutations: only one end or one axis counts; the error or the room for roundings is left
// out.
TEST(Viewpoint, RuleErrorBoundReachIsMoreThanTheWayToAnyVertex) {
  for (const float error : {0x1p-24F, 0x1p-20F, 64.0F})
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const float coordinate : {0.0F, -3.0F, 1e6F}) {
          Viewpoint viewpoint{};
          viewpoint.at[end][axis] = coordinate;
          const double farthest =
              0x1p24 * static_cast<double>(error) + std::abs(static_cast<double>(coordinate));
          const auto reach = static_cast<double>(reach_of(viewpoint, error));
          EXPECT_GT(reach, farthest * (1 + 0x1p-20) + 2 * static_cast<double>(error));
          EXPECT_LT(reach, farthest * 1.001);
        }
}

}  // namespace

}  // namespace cscd::fast
